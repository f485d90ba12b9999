// A verb of the command is a table: parser, --help and --help-all come from it.
#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace nacre::cli {

/// Wrong usage: exit 2. Wrong arguments that the library finds (std::invalid_argument) count as such too.
class UsageError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

struct Option {
    std::string flags;                             ///< "-o,--output", or "source" for a positional argument
    std::string value;                             ///< what stands for the value in --help; empty = a flag
    std::string summary;                           ///< one line
    std::function<void(const std::string&)> take;  ///< stores the value ("true" for a flag); throws UsageError
    bool required = false;
    std::vector<std::string> choices{};  ///< the only values accepted, when not empty
    bool repeats = false;                ///< may be given several times; taken each time
};

struct Verb {
    std::string name, summary;  ///< summary: one line in `nacre --help`
    std::string details;        ///< the rest of `nacre NAME --help`
    std::vector<Option> options;
    std::function<void()> run;  ///< throws nacre::Error (exit 1), UsageError or std::invalid_argument (exit 2)
};

/// What every verb shares.
struct Context {
    std::string commandLine;             ///< as typed, quoted for a shell
    std::vector<std::string> arguments;  ///< as typed, without the program's name
    bool quiet = false;                  ///< no progress
};

Verb modelsVerb(Context& context);
Verb methodsVerb(Context& context);
Verb factorizeVerb(Context& context);
Verb envmapVerb(Context& context);
Verb infoVerb(Context& context);
Verb evalVerb(Context& context);
Verb fresnelVerb(Context& context);
Verb bumpVerb(Context& context);
Verb shVerb(Context& context);
Verb transferVerb(Context& context);
Verb bakeVerb(Context& context);
Verb renderVerb(Context& context);
Verb viewVerb(Context& context);

/// The whole command but for main. \return the exit code
int runCommand(int argc, const char* const* argv);

// Takers for Option::take. They throw UsageError naming the flag and the range.
std::function<void(const std::string&)> into(std::string& target);
std::function<void(const std::string&)> into(bool& target);
/// \param low, high  inclusive
std::function<void(const std::string&)> integerInto(std::function<void(long long)> store, long long low,
                                                    long long high);
/// Finite and > 0.
std::function<void(const std::string&)> positiveInto(std::function<void(double)> store);
/// Finite, of either sign.
std::function<void(const std::string&)> finiteInto(double& target);

}  // namespace nacre::cli

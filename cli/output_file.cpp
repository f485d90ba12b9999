#include "cli/output_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cctype>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "cli/verb.hpp"
#include "core/error.hpp"

namespace nacre::cli {

namespace fs = std::filesystem;

fs::path provisionalName(const std::string& output) { return output + fmt::format(".{}.provisional", ::getpid()); }

/// Whatever its name, the file is what the ending says: a viewer that goes by the name would be misled.
static void requireEnding(const std::string& output, const std::string& ending) {
    std::string found = fs::path(output).extension().string(), lower = found;
    for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (!ending.empty() && lower != ending)
        throw UsageError(fmt::format("{}: expected a name that ends in {}, found {}", output, ending,
                                     found.empty() ? "no ending" : found));
}

void requireWritable(const std::vector<fs::path>& sources, const std::string& output, const fs::path& provisional,
                     const std::string& ending) {
    require(!output.empty(), "-o: expected a file name, found none");
    std::error_code failure;
    for (const fs::path& source : sources)
        require(!fs::equivalent(source, output, failure),
                fmt::format("{}: expected an output other than the source, which it would replace", output));
    if (fs::exists(output, failure) && !fs::is_regular_file(output, failure))
        throw Error(fmt::format("{}: can't write: expected a file or a free name, found a folder or device", output));
    requireEnding(output, ending);
    if (!std::ofstream(provisional)) throw Error(fmt::format("{}: can't write: {}", output, std::strerror(errno)));
    fs::remove(provisional, failure);  // it comes back for a moment after the bake; nothing is left by a kill before
}

}  // namespace nacre::cli

// The parser: verbs' tables into CLI11, exceptions into exit codes.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <csignal>
#include <new>

#include "cli/terminal.hpp"
#include "cli/verb.hpp"
#include "core/asset.hpp"
#include "core/error.hpp"
#include "core/temporary_files.hpp"
#include "core/version.hpp"

namespace nacre::cli {

std::function<void(const std::string&)> into(std::string& target) {
    return [&target](const std::string& text) { target = text; };
}

std::function<void(const std::string&)> into(bool& target) {
    return [&target](const std::string&) { target = true; };
}

std::function<void(const std::string&)> integerInto(std::function<void(long long)> store, long long low,
                                                    long long high) {
    return [=](const std::string& text) {
        long long value = 0;
        const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (failure != std::errc{} || end != text.data() + text.size() || value < low || value > high)
            throw UsageError(fmt::format("expected a whole number {} to {}, found '{}'", low, high, text));
        store(value);
    };
}

std::function<void(const std::string&)> positiveInto(std::function<void(double)> store) {
    return [=](const std::string& text) {
        double value = 0;
        const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (failure != std::errc{} || end != text.data() + text.size() || !std::isfinite(value) || value <= 0)
            throw UsageError(fmt::format("expected a finite number > 0, found '{}'", text));
        store(value);
    };
}

std::function<void(const std::string&)> finiteInto(double& target) {
    return [&target](const std::string& text) {
        double value = 0;
        const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (failure != std::errc{} || end != text.data() + text.size() || !std::isfinite(value))
            throw UsageError(fmt::format("expected a finite number, found '{}'", text));
        target = value;
    };
}

/// Words as a shell takes them back.
static std::string quoted(const std::string& word) {
    static constexpr std::string_view kPlain =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_=+.,:/@%";
    if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
    std::string out = "'";
    for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return out + "'";
}

static void addOption(CLI::App& app, const Option& option) {
    const auto take = [&option](const std::string& text) {
        try {
            option.take(text);
        } catch (const UsageError& error) {
            throw UsageError(fmt::format("{}: {}", option.flags.substr(option.flags.rfind(',') + 1), error.what()));
        }
    };
    if (option.value.empty()) {
        app.add_flag_callback(
            option.flags, [take] { take("true"); }, option.summary);
        return;
    }
    const auto takeAll = [take](const std::vector<std::string>& texts) {
        for (const std::string& text : texts) take(text);
    };
    CLI::Option* added = option.repeats
                             ? app.add_option_function<std::vector<std::string>>(option.flags, takeAll, option.summary)
                                   ->allow_extra_args(false)
                             : app.add_option_function<std::string>(option.flags, take, option.summary);
    added->type_name(option.value)->required(option.required);
    if (!option.choices.empty()) added->check(CLI::IsMember(option.choices))->type_name(option.value);
}

/// Declares the verb and, when it is the chosen one, leaves it in `chosen`.
static void addVerb(CLI::App& app, const Verb& verb, Context& context, const Verb*& chosen) {
    CLI::App* sub = app.add_subcommand(verb.name, verb.summary);
    sub->footer(verb.details);
    for (const Option& option : verb.options) addOption(*sub, option);
    sub->add_flag("-q,--quiet", context.quiet, "No progress; data and errors stay");
    sub->callback([&verb, &chosen] { chosen = &verb; });
}

/// CLI11 would only say that a subcommand is missing.
static void requireKnownVerb(const std::vector<Verb>& verbs, int argc, const char* const* argv) {
    if (argc > 1 && argv[1][0] == '-') return;
    std::string known;
    for (const Verb& verb : verbs) {
        if (argc > 1 && verb.name == argv[1]) return;
        known += (known.empty() ? "" : ", ") + verb.name;
    }
    throw UsageError(
        fmt::format("expected a verb, one of {}, found {}", known, argc > 1 ? fmt::format("'{}'", argv[1]) : "none"));
}

static std::vector<Verb> makeVerbs(Context& context) {
    return {factorizeVerb(context), envmapVerb(context), bumpVerb(context),   fresnelVerb(context), shVerb(context),
            transferVerb(context),  bakeVerb(context),   infoVerb(context),   evalVerb(context),    renderVerb(context),
            viewVerb(context),      modelsVerb(context), methodsVerb(context)};
}

static int parseAndRun(int argc, const char* const* argv) {
    Context context;
    for (int i = 0; i < argc; ++i) context.commandLine += (i ? " " : "") + quoted(i ? argv[i] : "nacre");
    context.arguments.assign(argv + std::min(argc, 1), argv + argc);
    const std::vector<Verb> verbs = makeVerbs(context);
    requireKnownVerb(verbs, argc, argv);
    CLI::App app("Bakes reflectance and light into small textures, each with its measured error written inside.",
                 "nacre");
    app.set_version_flag("--version", "nacre " + nacreVersion());
    app.set_help_all_flag("--help-all", "The help of every verb");
    app.require_subcommand(1);
    app.footer(
        "nacre VERB --help tells more.\nExit code: 0 done, 1 the work failed (a file, a budget), 2 wrong usage.");
    const Verb* chosen = nullptr;
    for (const Verb& verb : verbs) addVerb(app, verb, context, chosen);
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& help) {
        return app.exit(help);
    } catch (const CLI::ParseError& error) {
        throw UsageError(error.what());
    }
    chosen->run();
    flushData();
    return 0;
}

static std::string oneLine(std::string text) {
    for (char& c : text)
        if (c == '\n' || c == '\r') c = ' ';
    return text;
}

/// "VERB " when the line names one: whose help tells more.
static std::string knownVerb(int argc, const char* const* argv) {
    Context context;
    for (const Verb& verb : makeVerbs(context))
        if (argc > 1 && verb.name == argv[1]) return verb.name + " ";
    return "";
}

int runCommand(int argc, const char* const* argv) {
    std::signal(SIGXFSZ, SIG_IGN);  // a file size limit then is a failed write like a full disk
    removeTemporaryFilesOnSignals();
    try {
        return parseAndRun(argc, argv);
    } catch (const UsageError& error) {
        tell(fmt::format("{} (see nacre {}--help)", oneLine(error.what()), knownVerb(argc, argv)));
        return 2;
    } catch (const StorageError& error) {
        tell(oneLine(error.what()));
        return 1;
    } catch (const std::invalid_argument& error) {
        tell(oneLine(error.what()));
        return 2;
    } catch (const std::bad_alloc&) {
        tell("expected more memory, found none left");
        return 1;
    } catch (const std::exception& error) {
        tell(oneLine(error.what()));
        return 1;
    }
}

}  // namespace nacre::cli

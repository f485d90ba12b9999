// nacre models, nacre methods: what can go in, and the ways it can come out.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cli/terminal.hpp"
#include "cli/verb.hpp"
#include "factorize/factorize.hpp"
#include "factorize/micro/micro.hpp"
#include "factorize/models/models.hpp"

namespace nacre::cli {

using nlohmann::json;

static json modelJson(const ModelInfo& model) {
    json parameters = json::array();
    for (const ModelParameter& p : model.parameters)
        parameters.push_back(
            {{"name", p.name}, {"summary", p.summary}, {"range", p.range}, {"default", p.defaultValue}});
    return {{"name", model.name}, {"summary", model.summary}, {"source", model.source}, {"parameters", parameters}};
}

/// Characters of UTF-8 text: bytes that don't continue one.
static std::size_t widthOf(const std::string& text) {
    return static_cast<std::size_t>(
        std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; }));
}

/// `text` in lines of at most kColumns, broken at spaces; lines after the first start with `indent` spaces, as the
/// first one already does. A word longer than a line stays whole.
static std::string wrapped(const std::string& text, std::size_t indent) {
    static constexpr std::size_t kColumns = 100;
    std::string out;
    std::size_t column = indent;
    std::istringstream words(text);
    for (std::string word; words >> word;) {
        const std::size_t width = widthOf(word);
        if (!out.empty() && column + 1 + width > kColumns) {
            out += "\n" + std::string(indent, ' ');
            column = indent;
        } else if (!out.empty()) {
            out += ' ';
            ++column;
        }
        out += word;
        column += width;
    }
    return out + "\n";
}

/// Summary, then range and default on lines of their own: both are short for one parameter and long for the next.
static std::string parameterText(const ModelParameter& p) {
    static constexpr std::size_t kIndent = 17;
    const std::string range = fmt::format("{}; default {}", p.range, p.defaultValue);
    return fmt::format("    {:<12} {}", p.name, wrapped(p.summary, kIndent)) + std::string(kIndent, ' ') +
           wrapped(range, kIndent);
}

static std::string modelText(const ModelInfo& model) {
    std::string out = fmt::format("{}\n    {}", model.name, wrapped(model.summary + " [" + model.source + "]", 4));
    for (const ModelParameter& p : model.parameters) out += parameterText(p);
    return out;
}

static std::string methodText(const std::string& name, const std::string& text) {
    return fmt::format("{:<14} {}", name, wrapped(text, 15));
}

/// Analytic models, published fits and micro-geometries: everything that is named instead of read.
static std::vector<ModelInfo> allModels() {
    std::vector<ModelInfo> all = listModels();
    for (const ModelInfo& relief : listMicro()) all.push_back(relief);
    return all;
}

/// The models whose name is `name`, or all when it is empty.
static std::vector<ModelInfo> modelsNamed(const std::string& name) {
    if (name.empty()) return allModels();
    std::string known;
    for (const ModelInfo& model : allModels()) {
        if (model.name == name) return {model};
        known += (known.empty() ? "" : ", ") + model.name;
    }
    throw UsageError(fmt::format("unknown model '{}', expected one of: {}", name, known));
}

Verb modelsVerb(Context&) {
    struct Settings {
        std::string name;
        bool asJson = false;
    };
    const auto s = std::make_shared<Settings>();
    Verb verb{"models", "List the models and micro-geometries with their parameters", "", {}, {}};
    verb.details =
        "A model is written NAME or NAME:KEY=VALUE,KEY=VALUE, a micro-geometry micro:ridges,KEY=VALUE (or with a "
        "colon:\n"
        "micro:ridges:KEY=VALUE). Colours are one number or R/G/B.\n"
        "Example: nacre factorize torrance-sparrow:alpha=0.1,f=conductor,eta=1.5,k=3 -o metal.exr";
    verb.options = {{"name", "NAME", "Only this model", into(s->name)},
                    {"--json", "", "One JSON array on standard output", into(s->asJson)}};
    verb.run = [s] {
        const std::vector<ModelInfo> models = modelsNamed(s->name);
        json list = json::array();
        std::string text;
        for (const ModelInfo& model : models) {
            list.push_back(modelJson(model));
            text += modelText(model);
        }
        putData(s->asJson ? list.dump(2) + "\n" : text);
    };
    return verb;
}

Verb methodsVerb(Context&) {
    const auto asJson = std::make_shared<bool>(false);
    Verb verb{"methods", "List the factorizations and what they fit", "", {}, {}};
    verb.options = {{"--json", "", "One JSON array on standard output", into(*asJson)}};
    verb.run = [asJson] {
        json list = json::array();
        std::string text = methodText("auto", "the cheapest that meets the budget, else the most exact");
        for (const FactorizeMethod& m : factorizeMethods()) {
            list.push_back({{"name", m.name}, {"summary", m.summary}, {"fits", m.fits}});
            text += methodText(m.name, m.summary + " [fits: " + m.fits + "]");
        }
        putData(*asJson ? list.dump(2) + "\n" : text);
    };
    return verb;
}

}  // namespace nacre::cli

#include "core/json_field.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "core/error.hpp"

namespace nacre {

using nlohmann::json;

namespace {

constexpr std::size_t kMaxDepth = 64;  // of any sensible file; deeper ones would overflow those who walk them
constexpr std::size_t kMaxListed = 16;

/// A step of a JSON pointer (RFC 6901).
std::string step(const std::string& key) {
    std::string out = "/";
    for (const char c : key) out += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
    return out;
}

/// Follows the parser: where it is, and which keys each open object has had.
class Watcher : public nlohmann::json_sax<json> {
public:
    explicit Watcher(const std::string& name) : name_(name) {}

    bool null() override { return countItem(); }
    bool boolean(bool) override { return countItem(); }
    bool number_integer(number_integer_t) override { return countItem(); }
    bool number_unsigned(number_unsigned_t) override { return countItem(); }
    bool number_float(number_float_t, const string_t&) override { return countItem(); }
    bool string(string_t&) override { return countItem(); }
    bool binary(binary_t&) override { return countItem(); }
    bool start_object(std::size_t) override { return open(false); }
    bool start_array(std::size_t) override { return open(true); }
    bool end_object() override { return close(); }
    bool end_array() override { return close(); }
    bool key(string_t& key) override {
        open_.back().key = key;
        if (!open_.back().keys.insert(key).second)
            throw Error(fmt::format("{}: {}: expected each name once, found it twice", name_, path()));
        return true;
    }
    bool parse_error(std::size_t, const std::string&, const json::exception&) override { return false; }

private:
    struct Open {
        bool isArray;
        std::size_t items;
        std::string key;
        std::set<std::string> keys;
    };

    bool countItem() {
        if (!open_.empty() && open_.back().isArray) ++open_.back().items;
        return true;
    }
    bool open(bool isArray) {
        countItem();
        open_.push_back({isArray, 0, {}, {}});
        if (open_.size() > kMaxDepth)
            throw Error(fmt::format("{}: {}: expected at most {} levels, found more", name_, path(), kMaxDepth));
        return true;
    }
    bool close() {
        open_.pop_back();
        return true;
    }
    std::string path() const {
        std::string out;
        for (const Open& level : open_)
            out += level.isArray ? "/" + std::to_string(level.items ? level.items - 1 : 0) : step(level.key);
        return out;
    }

    const std::string& name_;
    std::vector<Open> open_;
};

/// "[json.exception.parse_error.101] parse error at line 3, column 5: syntax error …" without its first word.
std::string reasonOf(const json::exception& error) {
    const std::string text = error.what();
    const std::size_t end = text.find("] ");
    return end == std::string::npos ? text : text.substr(end + 2);
}

std::string listed(std::span<const std::string> names) {
    if (names.empty()) return "none";
    std::string out;
    for (std::size_t i = 0; i < std::min(names.size(), kMaxListed); ++i) out += (i ? ", " : "") + names[i];
    return names.size() > kMaxListed ? fmt::format("{} and {} more", out, names.size() - kMaxListed) : out;
}

std::vector<std::string> asStrings(std::initializer_list<std::string_view> words) {
    return {words.begin(), words.end()};
}

}  // namespace

json parseJson(std::string_view text, const std::string& name) {
    // Watched first, without values: the parser's own callback would make reading quadratic in an object's keys.
    Watcher watcher(name);
    json::sax_parse(text.begin(), text.end(), &watcher);
    try {
        return json::parse(text.begin(), text.end());
    } catch (const json::exception& error) {
        throw Error(fmt::format("{}: expected JSON, found: {}", name, reasonOf(error)));
    }
}

void JsonField::fail(const std::string& message) const {
    throw Error(fmt::format("{}: {}: {}", *file_, path_.empty() ? "/" : path_, message));
}

std::string JsonField::found() const {
    switch (value_->type()) {
        case json::value_t::object:
            return "an object";
        case json::value_t::array:
            return fmt::format("an array of {}", value_->size());
        case json::value_t::string: {
            const std::string& text = value_->get_ref<const std::string&>();
            return '"' + (text.size() > 80 ? text.substr(0, 80) + "…" : text) + '"';
        }
        default:
            return value_->dump();
    }
}

void JsonField::requireObject() const {
    if (!value_->is_object()) fail("expected an object, found " + found());
}

void JsonField::requireKeys(std::initializer_list<std::string_view> keys) const {
    requireObject();
    for (const auto& [key, ignored] : value_->items())
        if (std::find(keys.begin(), keys.end(), key) == keys.end())
            fail(fmt::format("no key named \"{}\"; there are {}", key, listed(asStrings(keys))));
}

std::optional<JsonField> JsonField::find(const std::string& key) const {
    requireObject();
    const auto at = value_->find(key);
    if (at == value_->end()) return {};
    return JsonField(*at, *file_, path_ + step(key));
}

JsonField JsonField::at(const std::string& key) const {
    const std::optional<JsonField> field = find(key);
    if (!field) fail(fmt::format("expected the key \"{}\", found none", key));
    return *field;
}

std::vector<std::pair<std::string, JsonField>> JsonField::members() const {
    requireObject();
    std::vector<std::pair<std::string, JsonField>> out;
    for (const auto& [key, value] : value_->items()) out.emplace_back(key, JsonField(value, *file_, path_ + step(key)));
    return out;
}

std::vector<JsonField> JsonField::items(std::size_t least, std::size_t most) const {
    const bool exactly = least == most;
    if (!value_->is_array() || value_->size() < least || value_->size() > most)
        fail(fmt::format("expected an array{}, found {}",
                         exactly                 ? fmt::format(" of {}", least)
                         : value_->size() > most ? fmt::format(" of at most {}", most)
                         : least                 ? fmt::format(" of at least {}", least)
                                                 : std::string(),
                         found()));
    std::vector<JsonField> out;
    for (std::size_t i = 0; i < value_->size(); ++i)
        out.emplace_back((*value_)[i], *file_, path_ + '/' + std::to_string(i));
    return out;
}

double JsonField::number(double low, double high) const {
    const double value = value_->is_number() ? value_->get<double>() : std::numeric_limits<double>::quiet_NaN();
    if (std::isfinite(value) && value >= low && value <= high) return value;
    const bool above = std::isfinite(low), below = std::isfinite(high);
    fail(fmt::format("expected a number{}, found {}",
                     above && below ? fmt::format(" from {:g} to {:g}", low, high)
                     : above        ? fmt::format(" of at least {:g}", low)
                     : below        ? fmt::format(" of at most {:g}", high)
                                    : std::string(),
                     found()));
}

double JsonField::positive() const {
    const double value = value_->is_number() ? value_->get<double>() : 0;
    if (!(value > 0) || !std::isfinite(value)) fail("expected a number above 0, found " + found());
    return value;
}

int JsonField::integer(int low, int high) const {
    const bool whole = value_->is_number_integer();
    const double value = whole ? value_->get<double>() : 0;
    if (!whole || value < low || value > high)
        fail(fmt::format("expected a whole number {} to {}, found {}", low, high, found()));
    return value_->get<int>();
}

bool JsonField::flag() const {
    if (!value_->is_boolean()) fail("expected true or false, found " + found());
    return value_->get<bool>();
}

std::string JsonField::text() const {
    if (!value_->is_string() || value_->get_ref<const std::string&>().empty())
        fail("expected a text, found " + found());
    return value_->get<std::string>();
}

Vec3 JsonField::vector() const {
    const std::vector<JsonField> v = items(3, 3);
    return {v[0].number(-kFarthest, kFarthest), v[1].number(-kFarthest, kFarthest), v[2].number(-kFarthest, kFarthest)};
}

Vec3 JsonField::direction() const {
    const std::vector<JsonField> d = items(3, 3);
    const Vec3 v{d[0].number(), d[1].number(), d[2].number()};
    const double length = glm::length(v);
    if (!(length > 1e-150) || !std::isfinite(length)) fail("expected a direction, found no length");
    return v / length;
}

Rgb JsonField::color(double most) const {
    if (value_->is_number()) return Rgb(number(0, most));
    const std::vector<JsonField> v = items(3, 3);
    return {v[0].number(0, most), v[1].number(0, most), v[2].number(0, most)};
}

Vec4 JsonField::quaternion() const {
    const std::vector<JsonField> v = items(4, 4);
    const Vec4 q{v[0].number(), v[1].number(), v[2].number(), v[3].number()};
    const double length = glm::length(q);
    if (!(std::abs(length - 1) < 1e-3))
        fail(fmt::format("expected a unit quaternion [x, y, z, w], found length {:g}", length));
    return q / length;
}

int JsonField::nameIn(const JsonNames& names, const char* what) const {
    const std::string name = text();
    const auto at = std::lower_bound(names.begin(), names.end(), name);
    if (at == names.end() || *at != name)
        fail(fmt::format("no {} named \"{}\"; there are {}", what, name, listed(names)));
    return static_cast<int>(at - names.begin());
}

int JsonField::choice(std::initializer_list<std::string_view> words) const {
    const std::string word = text();
    const auto at = std::find(words.begin(), words.end(), word);
    if (at == words.end()) fail(fmt::format("expected one of {}, found \"{}\"", listed(asStrings(words)), word));
    return static_cast<int>(at - words.begin());
}

}  // namespace nacre

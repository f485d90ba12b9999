// JSON that people write: values with the place they stand at, so that every message names file and path.
#pragma once

#include <initializer_list>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/math.hpp"

namespace nacre {

/// Text as JSON. \param name  what messages call the file
/// \throws nacre::Error with line and column for wrong syntax, with the path for a key used twice in an object, and
///         for nesting deeper than 64
nlohmann::json parseJson(std::string_view text, const std::string& name);

/// The names of a section in ascending order, as members() gives them; the place of a name is its index.
using JsonNames = std::vector<std::string>;

/// Largest coordinates and radiances: floats hold their products and squares.
inline constexpr double kFarthest = 1e9, kBrightest = 1e15;

/// A value in a document. All readers throw nacre::Error: "scene.json: /materials/gold/brdf: expected …, found …".
/// Refers to the document and to `file`, which must outlive it.
class JsonField {
public:
    JsonField(const nlohmann::json& value, const std::string& file, std::string path = {})
        : value_(&value), file_(&file), path_(std::move(path)) {}

    const nlohmann::json& value() const { return *value_; }
    const std::string& path() const { return path_; }
    [[noreturn]] void fail(const std::string& message) const;

    /// Of objects. \param keys  the only ones accepted
    void requireKeys(std::initializer_list<std::string_view> keys) const;
    void requireObject() const;
    std::optional<JsonField> find(const std::string& key) const;
    JsonField at(const std::string& key) const;                      ///< must be there
    std::vector<std::pair<std::string, JsonField>> members() const;  ///< by name

    /// Of arrays. \param least, most  how many items are accepted
    std::vector<JsonField> items(std::size_t least = 0,
                                 std::size_t most = std::numeric_limits<std::size_t>::max()) const;

    double number(double low = -std::numeric_limits<double>::infinity(),
                  double high = std::numeric_limits<double>::infinity()) const;  ///< finite, within both
    double positive() const;                                                     ///< finite, > 0
    int integer(int low, int high) const;
    bool flag() const;
    std::string text() const;                   ///< not empty
    Vec3 vector() const;                        ///< [x, y, z], each within kFarthest
    Vec3 direction() const;                     ///< the same, made unit; not zero
    Rgb color(double most = kBrightest) const;  ///< [r, g, b] or one number for all, ≥ 0
    Vec4 quaternion() const;                    ///< [x, y, z, w], of length 1 within 1e-3, made unit
    /// A name of `names`. \param what  "asset"  \return its index
    int nameIn(const JsonNames& names, const char* what) const;
    /// One of these words. \return which
    int choice(std::initializer_list<std::string_view> words) const;

private:
    std::string found() const;
    const nlohmann::json* value_;
    const std::string* file_;
    std::string path_;
};

}  // namespace nacre

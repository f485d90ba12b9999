// The two ways a call fails: wrong arguments (std::invalid_argument) and bad files or devices (nacre::Error).
#pragma once

#include <stdexcept>
#include <string>

namespace nacre {

/// A file or device that is not what it should be. The message is one line: path, what was expected, what was found.
class Error : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// \throws std::invalid_argument with `message` when `condition` is false: the check at a public door.
inline void require(bool condition, const std::string& message) {
    if (!condition) throw std::invalid_argument(message);
}
inline void require(bool condition, const char* message) {
    if (!condition) throw std::invalid_argument(message);
}

}  // namespace nacre

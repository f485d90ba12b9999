// How much room things take.
#pragma once

#include <cstddef>
#include <vector>

namespace nacre {

/// Of the heap, for a vector and, where its elements are vectors, theirs.
template <class T>
std::size_t bytesOf(const std::vector<T>& values) {
    return values.capacity() * sizeof(T);
}
template <class T>
std::size_t bytesOf(const std::vector<std::vector<T>>& lists) {
    std::size_t sum = lists.capacity() * sizeof(std::vector<T>);
    for (const std::vector<T>& list : lists) sum += bytesOf(list);
    return sum;
}

}  // namespace nacre

#include "bump/sweep.hpp"

namespace nacre {
namespace {

void joinInto(SweepBound& to, const SweepBound& from) {
    to.highest = std::max(to.highest, from.highest);
    to.twist = std::max(to.twist, from.twist);
}

}  // namespace

SweepCells::SweepCells(int columns, int rows)
    : across((columns + kColumns - 1) / kColumns),
      down((rows + kRows - 1) / kRows),
      cells(static_cast<std::size_t>(across) * down) {}

void SweepCells::join(int x, int y, const SweepBound& bound) {
    joinInto(cells[static_cast<std::size_t>(y / kRows) * across + static_cast<std::size_t>(x / kColumns)], bound);
}

SweepCells windowBounds(const SweepCells& own, Wrap wrap, int columns, int rows) {
    // The window's own cell and as many as hold the rest; one more, as the last cell before the seam may be cut short.
    const auto cellsOf = [](int window, int cell) { return (window + cell - 1) / cell + 2; };
    const int wide = std::min(cellsOf(columns, SweepCells::kColumns), own.across);
    const int high = std::min(cellsOf(rows, SweepCells::kRows), own.down);
    SweepCells across = own, out = own;
    const auto at = [&](int x, int y) {
        return static_cast<std::size_t>(y) * own.across + static_cast<std::size_t>(x);
    };
    for (int y = 0; y < own.down; ++y)
        for (int x = 0; x < own.across; ++x)
            for (int k = 1; k < wide; ++k)
                joinInto(across.cells[at(x, y)], own.cells[at(wrapIndex(x + k, own.across, wrap), y)]);
    for (int y = 0; y < own.down; ++y)
        for (int x = 0; x < own.across; ++x) {
            SweepBound& to = out.cells[at(x, y)];
            for (int k = 0; k < high; ++k) joinInto(to, across.cells[at(x, wrapIndex(y + k, own.down, wrap))]);
        }
    return out;
}

}  // namespace nacre

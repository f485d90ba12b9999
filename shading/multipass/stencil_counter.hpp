// How the stencil buffer's eight bits are shared (PR94 "Recursion", MPR section 7.3): values below SHAD_MIN count the
// levels of specular views, those from SHAD_MIN up count shadow volumes about SHAD_ZERO.
#pragma once

namespace nacre {

inline constexpr unsigned kStencilValues = 256;
inline constexpr unsigned kRenderArea = 0;                       ///< where the view of the moment is drawn
inline constexpr unsigned kShadowMin = kStencilValues / 2;       ///< SHAD_MIN: this bit says that counting goes on
inline constexpr unsigned kShadowZero = kStencilValues * 3 / 4;  ///< SHAD_ZERO: no volume contains the point
inline constexpr unsigned kShadowCounts = kShadowMin - 1;        ///< mask of the bits that count, and the highest
                                                                 ///< count that can't be taken for none
}  // namespace nacre

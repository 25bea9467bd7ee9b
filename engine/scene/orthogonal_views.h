// SPDX-License-Identifier: MIT
/// State of the orthogonal views: three planes through one point of the data, beside the 3D view.
#pragma once
#include <array>
#include <optional>
#include <string>

#include "engine/base/export.h"
#include "engine/base/vec.h"

namespace catena::scene {

/// What the planes show. World units.
struct OrthogonalViews {
  std::optional<Vec3> focus{};                    ///< Common point of the planes; empty: the middle of the base field
  std::optional<std::array<double, 2>> window{};  ///< Values shown as black and white; empty: the display range
  double zoom = 1;                                ///< Magnification; 1: every plane shows the whole field
  std::optional<Vec3> center{};                   ///< Point in the middle of every image; empty: the middle of the base field
  bool operator==(const OrthogonalViews&) const = default;
};

inline constexpr double kMinPlaneZoom = 0.2;  ///< Lower limit of OrthogonalViews::zoom
inline constexpr double kMaxPlaneZoom = 500;  ///< Upper limit of OrthogonalViews::zoom

/// Returns the state as a JSON object.
CATENA_EXPORT std::string to_json(const OrthogonalViews& views);

}  // namespace catena::scene

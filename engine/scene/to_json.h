// SPDX-License-Identifier: MIT
/// JSON text of values as in the scene file, on one line, for Document::set. Numbers are read back exactly; color components, which are
/// floats, have the fewest digits that give the same float. Precondition: all numbers are finite.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/base/vec.h"
#include "engine/scene/components.h"

namespace catena::scene {

struct Scene;

std::string to_json(double value);
std::string to_json(bool value);
std::string to_json(std::string_view value);  ///< In quotes
inline std::string to_json(const char* value) { return to_json(std::string_view(value)); }
std::string to_json(const Vec3& v);                                                ///< [x, y, z]
std::string to_json(const Quat& q);                                                ///< [w, x, y, z]
std::string to_json(const Color& c);                                               ///< [r, g, b]
std::string to_json(const std::array<double, 2>& range);                           ///< [min, max]
std::string to_json(const Threshold& threshold);                                   ///< [min, max], or two of them
std::string to_json(const std::vector<Vec3>& points);                              ///< [[x, y, z], ...]
std::string to_json(const std::vector<double>& values);                            ///< [a, b, ...]
std::string to_json(const std::vector<TransferFunction::ColorPoint>& table);       ///< "color": [[value, r, g, b], ...]
std::string to_json(const std::vector<TransferFunction::OpacityPoint>& table);     ///< "opacity": [[value, alpha], ...]
std::string to_json(const std::vector<TransferFunction::ExtinctionPoint>& table);  ///< "extinction": [[value, sigma], ...]
std::string to_json(const std::vector<TransferFunction::GradientPoint>& table);    ///< "gradient_opacity": [[gradient, factor], ...]
std::string to_json(const Camera& camera);
std::string to_json(const ClipPlane& plane);  ///< Item of "clip": {"plane": {"point", "normal"}}
std::string to_json(const Background& background);
std::string to_json(const Light& light);

/// Items of the scene's lists, written by their tables: required members, and members that differ from the default.
std::string to_json(const Scene& scene, const Volume& volume);
std::string to_json(const Scene& scene, const Isosurface& surface);
std::string to_json(const Scene& scene, const Slice& slice);
std::string to_json(const Scene& scene, const StreamlineSet& set);
std::string to_json(const Scene& scene, const GlyphSet& set);
std::string to_json(const Scene& scene, const std::string& name, const Widget& widget);
/// Value of "color_by".
std::string to_json(const Scene& scene, const ColorBy& by);

/// Returns the keys that state a widget's pose, with their values; an empty value removes the key, because another one states the same.
using Members = std::vector<std::pair<std::string, std::optional<std::string>>>;
Members pose_members(widget::Kind kind, const widget::Pose& pose);

}  // namespace catena::scene

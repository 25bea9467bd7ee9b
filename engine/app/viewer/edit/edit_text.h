/// Edits as JSON text for the scene's document, and the places they go to. Numbers are written so that they read back exactly.
/// Pure, any thread.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/app/viewer/edit/transfer_points.h"
#include "engine/base/json.h"

namespace catena::app {

/// "/volumes/2" for the item that was read from there (its label is "volumes[2]"); empty where it is no item of a list.
std::string pointer_of(const json::Node& item);
/// `key` with ~ and / as RFC 6901 writes them.
std::string pointer_to(std::string_view parent, std::string_view key);

std::string json_of(double value);  ///< a finite number
std::string json_of(bool value);
std::string json_of(const scene::Rgb& color);  ///< [r, g, b]
std::string json_of(const Vec3& v);
std::string json_of(const std::array<double, 2>& range);
std::string json_of(const ColorPoints& points);    ///< [[value, r, g, b], ...]
std::string json_of(const OpacityPoints& points);  ///< [[value, alpha], ...]
/// The node as it was read, on one line; without comments.
std::string json_of(const json::Node& node);

/// An object with some members left out and others added (or replaced, in place).
std::string json_with(const json::Node& object, const std::vector<std::string>& without,
                      const std::vector<std::pair<std::string, std::string>>& added);

}  // namespace catena::app

/// The file formats that hold fields, by the endings of their names (any case). Who asks for an ending, or prints which there are, asks
/// here. To add one: a reader with a row of the registry, NAME_format() in loaders.h, and a line in formats.cpp. Any thread.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace catena::field {

/// By its name alone.
bool is_field_file(std::string_view path);
/// Whether it is of a format that does not say its own layout (.raw): a scene or an option has to.
bool needs_layout(std::string_view path);
/// ".vdb", ".nii", ..; `bare`: of those that say their layout, which can be opened without a scene.
std::vector<std::string_view> field_endings(bool bare = false);
/// ".vdb, .nii, .nii.gz or .raw", for a sentence.
std::string field_file_words();

}  // namespace catena::field

/// What a page is told: JSON objects of one member each, and pictures. Frame thread.
///   {"role": {"hand": "yours" | "free" | "taken", "viewers": N}}
///   {"scene": {"name", "isosurfaces": [...], "volumes": [...], "maps": [...]}}   what can be changed
///   {"state": {"force": N, "most": N, "links": [{"name", "status"}], "hand": true, "picture": "..."}}   newton; hand: the pointer is it
///   {"note": "one line"}
/// A picture is a head of 16 bytes, little endian, and the file: number of the picture (4 bytes), number of the newest motion that it shows
/// (4), width and height of the page's picture (2, 2; the file may have fewer pixels), 1 for JPEG or 2 for PNG (1), 0 (1), milliseconds
/// that it took to draw and encode (2).
#pragma once
#include <cstdint>
#include <string>

#include "engine/app/viewer/edit/field_values.h"
#include "engine/app/viewer/shell/hand_host.h"
#include "engine/app/viewer/shell/scene_host.h"

namespace catena::app {

std::string role_words(const std::string& hand, std::size_t viewers);
/// `values`: for histograms; they come with a later call where they are still being sorted.
std::string scene_words(SceneHost& scene, FieldValues& values);
std::string state_words(const HandHost& hand, double max_force_n, bool hand_mode, const std::string& picture);
std::string note_words(const std::string& line);

struct PictureHead {
  std::uint32_t number = 0, motion = 0;
  std::uint32_t width = 0, height = 0;
  bool exact = false;  ///< PNG: every pixel as it is
  double ms = 0;
};
std::string picture_bytes(const PictureHead& head, const std::string& file);

}  // namespace catena::app

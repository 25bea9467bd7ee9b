/// What a page is told: JSON objects of one member each, and pictures. Frame thread.
///   {"role": {"hand": "yours" | "free" | "taken", "viewers": N}}
///   {"scene": {"name", "isosurfaces": [...], "volumes": [...], "maps": [...]}}   what can be changed
///   {"state": {"force": N, "most": N, "links": [{"name", "status"}], "hand": true, "picture": "...",   newton; hand: the pointer is it
///              "step": {"now", "count", "time", "plays"}, "undo": "isolevel", "redo": "",   time: null where none is stated; what undo
///              takes back, empty: nothing
///              "recording": {"on", "seconds", "mb", "file"}, "plan": {"place", "eye", "hand"}}}   file: to be fetched, empty: none; plan:
///              null where it was not measured, or decides nothing
///   {"note": "one line"}
/// A picture is a head of 16 bytes, little endian, and the file: number of the picture (4 bytes), number of the newest motion that it shows
/// (4), width and height of the page's picture (2, 2; the file may have fewer pixels), 1 for JPEG or 2 for PNG (1), 0 (1), milliseconds
/// that it took to draw and encode (2).
#pragma once
#include <cstdint>
#include <string>

#include "engine/app/viewer/edit/field_values.h"
#include "engine/app/viewer/shell/live_plan.h"

namespace catena::app {

std::string role_words(const std::string& hand, std::size_t viewers);
/// `values`: for histograms; they come with a later call where they are still being sorted.
std::string scene_words(SceneHost& scene, FieldValues& values);
struct StateWords {
  bool hand_mode = false, plays = false;
  std::string picture;
  const LivePlan& plan;
  std::string recorded;  ///< the name of the file that can be fetched
};
std::string state_words(const HandHost& hand, const SceneHost& scene, const StateWords& more);
std::string note_words(const std::string& line);

struct PictureHead {
  std::uint32_t number = 0, motion = 0;
  std::uint32_t width = 0, height = 0;
  bool exact = false;  ///< PNG: every pixel as it is
  double ms = 0;
};
std::string picture_bytes(const PictureHead& head, const std::string& file);

}  // namespace catena::app

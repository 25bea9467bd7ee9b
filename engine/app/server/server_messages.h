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

#include "engine/app/viewer/edit/histogram_cache.h"
#include "engine/app/viewer/window/live_tuning.h"

namespace catena::app {

std::string role_message(const std::string& hand, std::size_t viewers);
/// `values`: for histograms; they come with a later call where they are still being sorted.
std::string scene_message(SceneModel& scene, HistogramCache& values);
struct SessionState {
  bool probe_mode = false, is_playing = false;
  std::string image_description;
  const LiveTuning& tuning;
  std::string recording_name;  ///< the name of the file that can be fetched
};
std::string state_message(const HapticSession& hand, const SceneModel& scene, const SessionState& more);
std::string note_message(const std::string& line);

struct FrameHeader {
  std::uint32_t number = 0, input_number = 0;
  std::uint32_t width = 0, height = 0;
  bool is_lossless = false;  ///< PNG: every pixel as it is
  double elapsed_ms = 0;
};
std::string frame_message(const FrameHeader& head, const std::string& file);

}  // namespace catena::app

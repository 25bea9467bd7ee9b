// SPDX-License-Identifier: MIT
/// Messages to a page: JSON objects of one member each, and frames. Frame thread. The keys are those of the protocol.
///   {"role": {"control": "yours" | "free" | "taken", "viewers": N}}                  whether this page is in control
///   {"scene": {"name", "isosurfaces": [...], "volumes": [...], "maps": [...]}}       what can be edited
///   {"state": {
///      "force": N, "max_force": N,                       force and maximum force, N
///      "links": [{"name", "status"}], "picture": "...",  "picture": description of the image
///      "probe": true,                                    the pointer moves the probe
///      "step": {"now", "count", "time", "plays"},        "time": null if the time steps have no times
///      "undo": "isolevel", "redo": "",                   labels of what undo and redo change; empty: nothing
///      "recording": {"on", "seconds", "mb", "file"},     "file": name of the file to download; empty: none
///      "tuning": {"position", "image", "haptics"}}}      slider position, image tuning, tick tuning; null: not measured, or unused
///   {"note": "one line"}
/// A frame is a header of 16 bytes, little endian, followed by the image file: frame number (4 bytes), number of the newest input that the
/// frame shows (4), width and height of the page's image (2, 2; the file may have fewer pixels), 1 for JPEG or 2 for PNG (1), 0 (1),
/// milliseconds spent on rendering and encoding (2).
#pragma once
#include <cstdint>
#include <string>

#include "engine/app/viewer/edit/histogram_cache.h"
#include "engine/app/viewer/window/live_tuning.h"

namespace catena::app {

/// The message "role". `control`: "yours", "free" or "taken"; `viewers`: number of connected pages.
std::string role_message(const std::string& control, std::size_t viewers);
/// The message "scene". `values`: cache of the histograms; those that are still being computed are sent with a later message.
std::string scene_message(SceneModel& scene, HistogramCache& values);
/// State of the session for the message "state", in addition to the haptics and the scene.
struct SessionState {
  bool probe_mode = false, is_playing = false;
  std::string image_description;
  const LiveTuning& tuning;
  std::string recording_name;  ///< Name of the recording that can be downloaded; empty: none
};
/// The message "state".
std::string state_message(const HapticSession& hand, const SceneModel& scene, const SessionState& more);
/// The message "note".
std::string note_message(const std::string& line);

/// Values of a frame's header.
struct FrameHeader {
  std::uint32_t number = 0, input_number = 0;
  std::uint32_t width = 0, height = 0;
  bool is_lossless = false;  ///< PNG; false: JPEG
  double elapsed_ms = 0;
};
/// The binary message of a frame.
std::string frame_message(const FrameHeader& head, const std::string& file);

}  // namespace catena::app

// SPDX-License-Identifier: MIT
/// Requests of a page, as they arrive over the network: one JSON object with the key "do". Anything else is rejected, and every number is
/// checked to be finite and within bounds. Pure, any thread.
///   {"do": "move", "number": N, "pieces": [[x, y, dx, dy, wheel, held], ...]}
///                                      pointer and wheel input (navigation.h), pixels of the image;
///                                      held: sum of 1 left, 2 middle, 4 right button, 8 shift, 16 control, 32 space
///   {"do": "size", "width": W, "height": H}                of the image, pixels
///   {"do": "probe" | "fit" | "first_view" | "along_x" | ...}  an action of the viewer (commands.h)
///   {"do": "level", "item": "isosurfaces[0]", "value": V}
///   {"do": "opacity", "item": "volumes[0]", "points": [[value, alpha], ...]}
///   {"do": "map", "item": "volumes[0]", "name": "viridis"}
///   {"do": "step", "value": N}                             time step
///   {"do": "record" | "stop_recording"}                    records every haptic tick; the page can download the recording
///   {"do": "tune", "position": S}                          position of the tuning slider, from 0, fast, to 1, exact;
///                                                          without "position": measures the costs that the tuning uses
///   {"do": "take_control" | "release_control"}             takes or releases control, which one page has at a time
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "engine/app/viewer/edit/transfer_editing.h"
#include "engine/app/viewer/input/commands.h"
#include "engine/app/viewer/input/navigation.h"

namespace catena::app {

inline constexpr std::uint32_t kMinPageSize = 16, kMaxPageSize = 4096;  ///< Width and height of a page's image, pixels
/// Maximum number of inputs of a "move" and of points of an "opacity" request.
inline constexpr std::size_t kMaxInputs = 64, kMaxOpacityPoints = 256;

/// "move": pointer and wheel input.
struct MoveRequest {
  /// Increases with each request; a frame's header contains the number of the newest request that the frame shows
  std::uint32_t number = 0;
  std::vector<Input> inputs;  ///< Width and height are not set
};
/// "size": size of the page's image, pixels.
struct SizeRequest {
  std::uint32_t width = 0, height = 0;
};
/// "level": isovalue of an isosurface.
struct LevelRequest {
  std::string item;
  double value = 0;
};
/// "opacity": opacity points of a volume.
struct OpacityRequest {
  std::string item;
  OpacityPoints points;
};
/// "map": color map of a volume.
struct ColormapRequest {
  std::string item, name;
};
/// "step": time step, from 0.
struct StepRequest {
  int step = 0;
};
/// "record" or "stop_recording".
struct RecordRequest {
  bool on = false;
};
/// "tune": position of the tuning slider, 0 to 1; empty: measure the costs.
struct TuningRequest {
  std::optional<double> position;
};
/// "take_control" or "release_control".
enum class ControlRequest : std::uint8_t { take, release };

/// Any request of a page.
using ClientRequest = std::variant<MoveRequest, SizeRequest, Action, LevelRequest, OpacityRequest, ColormapRequest, StepRequest,
                                   RecordRequest, TuningRequest, ControlRequest>;

/// Parses a message. Error: one line that names the problem.
Result<ClientRequest> parse_request(std::string_view words);

}  // namespace catena::app

/// What a page asks for, as it comes over the network: one JSON object with the word "do". Nothing else is taken, and every number is
/// finite and bounded before anybody sees it. Pure, any thread.
///   {"do": "move", "number": N, "pieces": [[x, y, dx, dy, wheel, held], ...]}   pointer and wheel (controls.h), pixels of the picture;
///                                      held: 1 left, 2 middle, 4 right button, 8 shift, 16 control, 32 space
///   {"do": "size", "width": W, "height": H}                of the picture, pixels
///   {"do": "hand" | "fit" | "first_view" | "view_along_plus_x" | ...}  an action of the window (commands.h)
///   {"do": "level", "item": "isosurfaces[0]", "value": V}
///   {"do": "opacity", "item": "volumes[0]", "points": [[value, alpha], ...]}
///   {"do": "map", "item": "volumes[0]", "name": "viridis"}
///   {"do": "step", "value": N}                             in time
///   {"do": "record" | "stop_recording"}                    every tick of the hand; the page can fetch what was recorded
///   {"do": "plan", "place": S}                             from 0, fast, to 1, exact; without a place: what it goes by is measured first
///   {"do": "take" | "give"}                                the hand, which one page has at a time
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

inline constexpr std::uint32_t kMinPageSize = 16, kMaxPageSize = 4096;  ///< pixels of a page's picture, each way
inline constexpr std::size_t kMaxInputs = 64, kMaxOpacityPoints = 256;

struct MoveRequest {
  std::uint32_t number = 0;   ///< counts up; the first picture that shows what it did comes back with it
  std::vector<Input> inputs;  ///< width and height are not set
};
struct SizeRequest {
  std::uint32_t width = 0, height = 0;
};
struct LevelRequest {
  std::string item;
  double value = 0;
};
struct OpacityRequest {
  std::string item;
  OpacityPoints points;
};
struct ColormapRequest {
  std::string item, name;
};
struct StepRequest {
  int step = 0;
};
struct RecordRequest {
  bool on = false;
};
struct TuningRequest {
  std::optional<double> position;
};
enum class ControlRequest : std::uint8_t { take, release };

using ClientRequest = std::variant<MoveRequest, SizeRequest, Action, LevelRequest, OpacityRequest, ColormapRequest, StepRequest,
                                   RecordRequest, TuningRequest, ControlRequest>;

/// One line says what is wrong.
Result<ClientRequest> parse_request(std::string_view words);

}  // namespace catena::app

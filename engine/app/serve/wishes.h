/// What a page asks for, as it comes over the network: one JSON object with the word "do". Nothing else is taken, and every number is
/// finite and bounded before anybody sees it. Pure, any thread.
///   {"do": "move", "number": N, "pieces": [[x, y, dx, dy, wheel, held], ...]}   pointer and wheel (controls.h), pixels of the picture;
///                                      held: 1 left, 2 middle, 4 right button, 8 shift, 16 control, 32 space
///   {"do": "size", "width": W, "height": H}                of the picture, pixels
///   {"do": "hand" | "fit" | "first_view" | "along_x" | ...}  an action of the window (commands.h)
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

#include "engine/app/viewer/edit/transfer_edit.h"
#include "engine/app/viewer/shell/commands.h"
#include "engine/app/viewer/shell/controls.h"

namespace catena::app {

inline constexpr std::uint32_t kLeastPage = 16, kMostPage = 4096;  ///< pixels of a page's picture, each way
inline constexpr std::size_t kMostPieces = 64, kMostPoints = 256;

struct MoveWish {
  std::uint32_t number = 0;   ///< counts up; the first picture that shows what it did comes back with it
  std::vector<Input> pieces;  ///< width and height are not set
};
struct SizeWish {
  std::uint32_t width = 0, height = 0;
};
struct LevelWish {
  std::string item;
  double value = 0;
};
struct OpacityWish {
  std::string item;
  OpacityPoints points;
};
struct MapWish {
  std::string item, name;
};
struct StepWish {
  int step = 0;
};
struct RecordWish {
  bool on = false;
};
struct PlanWish {
  std::optional<double> place;
};
enum class HandWish : std::uint8_t { take, give };

using Wish = std::variant<MoveWish, SizeWish, Action, LevelWish, OpacityWish, MapWish, StepWish, RecordWish, PlanWish, HandWish>;

/// One line says what is wrong.
Result<Wish> parse_wish(std::string_view words);

}  // namespace catena::app

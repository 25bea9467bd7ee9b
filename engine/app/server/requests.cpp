// SPDX-License-Identifier: MIT
#include "engine/app/server/requests.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/base/json.h"

namespace catena::app {

namespace {

constexpr double kFarthest = 1e5;  // maximum magnitude of a pointer coordinate, pixels
constexpr std::pair<std::string_view, Action> kActions[] = {{"probe", Action::toggle_probe_mode},
                                                            {"fit", Action::fit_view},
                                                            {"first_view", Action::reset_view},
                                                            {"along_x", Action::view_along_plus_x},
                                                            {"along_y", Action::view_along_plus_y},
                                                            {"along_z", Action::view_along_plus_z},
                                                            {"against_x", Action::view_along_minus_x},
                                                            {"against_y", Action::view_along_minus_y},
                                                            {"against_z", Action::view_along_minus_z},
                                                            {"projection", Action::toggle_projection},
                                                            {"turntable", Action::toggle_turntable},
                                                            {"undo", Action::undo},
                                                            {"redo", Action::redo},
                                                            {"play_steps", Action::play_time_steps},
                                                            {"next_step", Action::next_time_step},
                                                            {"step_before", Action::previous_time_step}};

Result<Input> piece_of(const std::vector<double>& row) {
  for (const double number : row)
    if (!(std::abs(number) <= kFarthest)) return Error{"pieces: a number is out of range"};
  const int held = static_cast<int>(row[5]);
  if (held < 0 || held > 63 || held != row[5])
    return Error{"pieces: expected a sum of 1, 2, 4, 8, 16 and 32 for the buttons and keys held"};
  Input piece;
  piece.x = row[0], piece.y = row[1], piece.dx = row[2], piece.dy = row[3], piece.wheel = row[4];
  piece.left = held & 1, piece.middle = held & 2, piece.right = held & 4;
  piece.shift = held & 8, piece.control = held & 16, piece.space = held & 32;
  return piece;
}

Result<std::vector<std::vector<double>>> rows_of(const json::Node& node, std::string_view key, std::size_t width, std::size_t maximum) {
  const json::Node* list = node.find(key);
  if (list == nullptr || list->kind != json::Kind::array || list->items.empty() || list->items.size() > maximum)
    return Error{std::string(key) + ": expected 1 to " + std::to_string(maximum) + " rows of numbers"};
  return json::as_rows(*list, key, width);
}

Result<ClientRequest> move_of(const json::Node& node) {
  MoveRequest request;
  CATENA_TRY(const int number, json::get_integer(node, "number", 0, 0, 2'000'000'000));
  request.number = static_cast<std::uint32_t>(number);
  CATENA_TRY(const auto rows, rows_of(node, "pieces", 6, kMaxInputs));
  for (const std::vector<double>& row : rows) {
    CATENA_TRY(Input piece, piece_of(row));
    request.inputs.push_back(std::move(piece));
  }
  return ClientRequest{std::move(request)};
}

Result<ClientRequest> opacity_of(const json::Node& node) {
  OpacityRequest request;
  CATENA_TRY(request.item, json::require_string(node, "item"));
  CATENA_TRY(const auto rows, rows_of(node, "points", 2, kMaxOpacityPoints));
  for (const std::vector<double>& row : rows) request.points.push_back({row[0], std::clamp(row[1], 0.0, kMaxAlpha)});
  return ClientRequest{std::move(request)};
}

}  // namespace

Result<ClientRequest> parse_request(std::string_view words) {
  CATENA_TRY(const json::Node node, json::parse(words, "message"));
  CATENA_CHECK(json::expect_object(node, "a message"));
  CATENA_TRY(const std::string what, json::require_string(node, "do"));
  for (const auto& [word, action] : kActions)
    if (what == word) return ClientRequest{action};
  if (what == "take_control") return ClientRequest{ControlRequest::take};
  if (what == "release_control") return ClientRequest{ControlRequest::release};
  if (what == "record") return ClientRequest{RecordRequest{true}};
  if (what == "stop_recording") return ClientRequest{RecordRequest{false}};
  if (what == "step") {
    CATENA_TRY(const int step, json::get_integer(node, "value", -1, 0, 1'000'000'000));
    if (step < 0) return Error{"step: expected a number of at least 0"};
    return ClientRequest{StepRequest{step}};
  }
  if (what == "tune") {
    if (node.find("position") == nullptr) return ClientRequest{TuningRequest{}};
    CATENA_TRY(const double position, json::require_number(node, "position"));
    if (!(position >= 0 && position <= 1)) return Error{"position: expected a number from 0 to 1"};
    return ClientRequest{TuningRequest{position}};
  }
  if (what == "move") return move_of(node);
  if (what == "opacity") return opacity_of(node);
  if (what == "size") {
    CATENA_TRY(const int width, json::get_integer(node, "width", 0, static_cast<int>(kMinPageSize), static_cast<int>(kMaxPageSize)));
    CATENA_TRY(const int height, json::get_integer(node, "height", 0, static_cast<int>(kMinPageSize), static_cast<int>(kMaxPageSize)));
    if (width == 0 || height == 0) return Error{"size: expected width and height"};
    return ClientRequest{SizeRequest{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)}};
  }
  if (what == "level") {
    LevelRequest request;
    CATENA_TRY(request.item, json::require_string(node, "item"));
    CATENA_TRY(request.value, json::require_number(node, "value"));
    return ClientRequest{std::move(request)};
  }
  if (what == "map") {
    ColormapRequest request;
    CATENA_TRY(request.item, json::require_string(node, "item"));
    CATENA_TRY(request.name, json::require_string(node, "name"));
    return ClientRequest{std::move(request)};
  }
  return Error{"unknown request"};
}

}  // namespace catena::app

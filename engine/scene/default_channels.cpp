// SPDX-License-Identifier: MIT
#include "engine/scene/default_channels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/base/numbers.h"
#include "engine/field/field_display_range.h"
#include "engine/scene/to_json.h"

namespace catena::scene {
namespace {

constexpr double kMeanChannelDepth = 3.5,
                 kMaxChannelDepth = 150;  // optical depths of a ray across the domain: the mean one, and one in full color
constexpr Color kColors[] = {{0, 1, 0}, {1, 0, 1}, {0, 1, 1}, {1, 1, 0}};

bool has_same_place(const field::GridInfo& a, const field::GridInfo& b) {
  const auto numbers = [](const field::GridInfo& grid) { return std::array{grid.size.x, grid.size.y, grid.size.z}; };
  return numbers(a) == numbers(b) && a.mapping.origin == b.mapping.origin &&
         a.mapping.world_from_index_linear == b.mapping.world_from_index_linear;
}

Color color_of(const field::GridInfo& grid, std::size_t number) {
  if (grid.color < 0) return kColors[number % std::size(kColors)];
  constexpr int kBits = 8, kMax = 255;
  const auto component = [&](int at) { return float(grid.color >> (at * kBits) & kMax) / float(kMax); };
  return {component(2), component(1), component(0)};
}

std::array<double, 2> window_of(const Channel& channel) {
  const std::vector<double>& window = channel.grid->window;
  if (window.size() == 2 && window[0] < window[1]) return {window[0], window[1]};
  const DisplayRange range = field::display_range(channel.field);
  return {range.lo, range.lo < range.hi ? range.hi : range.lo + 1};
}

/// Returns the mean of the positions of the values in a window, 0 to 1, from an even sample.
double mean_share(const field::ScalarField& field, const std::array<double, 2>& window) {
  constexpr int kPerAxis = 32;
  const Bounds box = field.world_bounds();
  field::Cursor cursor;
  double sum = 0;
  for (int i = 0; i < kPerAxis * kPerAxis * kPerAxis; ++i) {
    const Vec3 share = (Vec3(i % kPerAxis, i / kPerAxis % kPerAxis, i / kPerAxis / kPerAxis) + Vec3(0.5)) / double(kPerAxis);
    const field::ScalarSample sample = field.sample(box.lo + share * (box.hi - box.lo), cursor);
    if (sample.inside) sum += std::clamp((sample.value - window[0]) / (window[1] - window[0]), 0.0, 1.0);
  }
  return sum / (kPerAxis * kPerAxis * kPerAxis);
}

}  // namespace

std::vector<const field::GridInfo*> find_channels(const std::vector<field::GridInfo>& grids) {
  const auto is_marked = [](const field::GridInfo& grid) { return grid.color >= 0 || grid.name.starts_with("channel "); };
  const auto first = std::ranges::find_if(grids, is_marked);
  std::vector<const field::GridInfo*> channels;
  if (first == grids.end()) return channels;
  for (const field::GridInfo& grid : grids)
    if (!grid.levels.empty() && grid.is_usable && !grid.is_vector && has_same_place(grid, *first)) channels.push_back(&grid);
  if (channels.size() < 2) channels.clear();
  return channels;
}

std::string channel_volumes(const std::vector<Channel>& channels) {
  std::string text = "  \"volumes\": [";
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const auto [lo, hi] = window_of(channels[i]);
    const double mean = std::max(mean_share(*channels[i].field.scalar, {lo, hi}), 1e-6);
    const double extinction = round_to_digits(
        std::clamp(kMeanChannelDepth / mean, kMeanChannelDepth, kMaxChannelDepth) / channels[i].field.get()->domain_length(), 3);
    const Color color = color_of(*channels[i].grid, i);
    text += (i > 0 ? ",\n              " : "") +
            fmt::format("{{\"field\": {}, \"color\": {}, \"extinction\": {}}}", channels[i].field_name,
                        to_json(std::vector<TransferFunction::ColorPoint>{{lo, color}, {hi, color}}),
                        to_json(std::vector<TransferFunction::ExtinctionPoint>{{lo, 0}, {hi, extinction}}));
  }
  return text + "]";
}

std::string channels_note(const std::vector<Channel>& channels, std::size_t count) {
  std::string text = count == 1                ? std::string("channel")
                     : count > channels.size() ? fmt::format("{} of {} channels", channels.size(), count)
                                               : fmt::format("{} channels", count);
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const Color color = color_of(*channels[i].grid, i);
    const auto byte = [](float component) { return int(std::lround(255 * component)); };
    const auto [lo, hi] = window_of(channels[i]);
    text += fmt::format("{} {} #{:02x}{:02x}{:02x} from {} to {}", i == 0 ? ":" : ",", channels[i].field_name, byte(color.r), byte(color.g),
                        byte(color.b), format_readable(lo), format_readable(hi));
  }
  return text;
}

}  // namespace catena::scene

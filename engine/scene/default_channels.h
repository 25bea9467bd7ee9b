// SPDX-License-Identifier: MIT
/// Default visualization of the channels of a microscope's image: one volume each, in the channel's color, visible above the lower end of
/// its display window.
///   color    that of the file (OME metadata), else green, magenta, cyan, yellow in order
///   window   that of the file, else the display range
///   opacity  rises linearly over the window; the mean ray across the domain has the optical depth kMeanChannelDepth, at most
///   kMaxChannelDepth in full
#pragma once
#include <string>
#include <vector>

#include "engine/field/field.h"
#include "engine/io/volume/load_field.h"

namespace catena::scene {

/// A channel with its loaded field.
struct Channel {
  const field::GridInfo* grid = nullptr;
  std::string field_name;  ///< In the scene, as a JSON string
  field::AnyField field;
};

/// Most channels that are shown.
inline constexpr std::size_t kMaxChannels = 4;

/// Returns the channels among the grids of a file: two or more scalar grids of one size and position, at least one of which has a color in
/// the file or the name "channel N". Empty: there are none.
std::vector<const field::GridInfo*> find_channels(const std::vector<field::GridInfo>& grids);
/// Returns the member "volumes" of a scene that shows the channels.
std::string channel_volumes(const std::vector<Channel>& channels);
/// Returns the names, colors and windows of the channels that are shown, of `count`, for a note.
std::string channels_note(const std::vector<Channel>& channels, std::size_t count);

}  // namespace catena::scene

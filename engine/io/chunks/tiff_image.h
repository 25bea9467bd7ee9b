// SPDX-License-Identifier: MIT
/// Images of a TIFF file: which page holds which slice, channel and time.
///   OME-XML       in the first page's description: sizes, order of dimensions, planes by TiffData, units, channels, times
///   ImageJ        in the first page's description: channels fastest, then slices, then frames; spacing, unit
///   otherwise     every page of the first page's size and type is a slice
/// The samples of a pixel are channels.
#pragma once
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/base/vec.h"
#include "engine/io/chunks/tiff_pages.h"

namespace catena::chunks {

/// Page of a file; file -1: there is none, the plane is 0.
struct TiffPlane {
  int file = -1, page = 0;
};

/// An image: its planes and what describes them.
struct TiffImage {
  std::string name;
  int slices = 1, planes = 1, samples = 1, steps = 1;  ///< Channels: planes * samples.
  std::vector<TiffPlane> pages;                        ///< By time, plane and slice, slices fastest.
  Vec3 spacing{0.0};                                   ///< 0: not specified.
  std::string length_unit;
  double time_step = 1;
  std::string time_unit;
  std::vector<std::string> channels;  ///< Names; fewer than channels: not specified.
  std::vector<int> colors;            ///< 0xRRGGBB, -1: not specified.

  /// Returns a page's place in `pages`.
  std::size_t place(int step, int plane, int slice) const {
    return (static_cast<std::size_t>(step) * static_cast<std::size_t>(planes) + static_cast<std::size_t>(plane)) *
               static_cast<std::size_t>(slices) +
           static_cast<std::size_t>(slice);
  }
};

/// What is known of a file: its pages, the description of the first one, its pixels per unit of length (0: not specified).
struct TiffHead {
  std::string file_name;
  std::vector<TiffPage> pages;
  std::string description;
  double pixels_per_unit[2] = {0, 0};
};

/// Finds the images. `files`: receives the names of all files that belong to them, this one first. `notes`: what is left out. Returns an
/// Error with a message fragment.
Result<std::vector<TiffImage>> find_tiff_images(const TiffHead& head, std::vector<std::string>& files, std::vector<std::string>& notes);

}  // namespace catena::chunks

// SPDX-License-Identifier: MIT
/// Statistics of `render --stats`.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/scene/scene.h"
#include "render/frame/frame_packet.h"
#include "render/residency/residency_manager.h"

namespace catena::app {

/// Timings, quality and memory of one run of `catena render`.
struct FrameStats {
  std::string device, driver;
  /// Per frame, from the start of extraction to the fence of the color image; the first frame includes pipelines and grid uploads
  std::vector<double> frame_ms;
  double first_frame_ms = 0, load_ms = 0, residency_ms = 0, encode_ms = 0;
  /// Time to search for settings that reach a target error or time; for a sequence with a target error, including the second search after
  /// the first frame
  double settings_search_ms = 0;
  std::string quality_mode;
  std::optional<double> estimated_rmse;     ///< Estimated RMS error of the image, 1/255; empty if it was not measured (only time=, error=,
                                            ///< balanced, reference and a tuning)
  std::uint32_t tiles = 1;                  ///< Number of tiles per frame
  std::vector<render::ObjectName> objects;  ///< Objects that the ids of --ids denote
  std::vector<render::GridDownsampling> downsampled_grids;  ///< Grids that were rendered below their resolution in the first frame
  std::uint64_t cpu_bytes = 0, gpu_bytes = 0, gpu_budget_bytes = 0, validation_messages = 0;

  /// Median of frame_ms.
  double median_ms() const;
  /// The statistics as a JSON object.
  std::string to_json() const;
};

/// The objects as JSON on one line: [{"id": 1, "kind": "volume", "name": "density"}, ..].
std::string objects_json(const std::vector<render::ObjectName>& objects);

/// Bytes of all loaded data of a scene; a grid that several entities share counts only the first time.
std::uint64_t loaded_data_bytes(const scene::Scene& scene);

}  // namespace catena::app

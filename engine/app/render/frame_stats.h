/// `render --stats`: the figures of a picture, and where they come from.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/scene/scene.h"
#include "render/frame/frame_packet.h"
#include "render/residency/residency_manager.h"

namespace catena::app {

struct FrameStats {
  std::string device, driver;
  std::vector<double> frame_ms;  ///< start of extraction to the fence of the colour image; the first one's with pipelines and mirrors
  double first_frame_ms = 0, load_ms = 0, residency_ms = 0, encode_ms = 0;
  double settings_search_ms = 0;  ///< to find settings for an error or a time; of a sequence again after the first frame
  std::string quality_mode;
  std::optional<double> estimated_rmse;                     ///< 1/255; measured for time= and error= only
  std::uint32_t tiles = 1;                                  ///< that a frame is drawn in
  std::vector<render::ObjectName> objects;                  ///< what the ids of --ids stand for
  std::vector<render::GridDownsampling> downsampled_grids;  ///< grids drawn at less than their resolution, by the first frame
  std::uint64_t cpu_bytes = 0, gpu_bytes = 0, gpu_budget_bytes = 0, validation_messages = 0;

  double median_ms() const;
  std::string to_json() const;
};

/// [{"id": 1, "kind": "volume", "name": "density"}, ..], on one line.
std::string objects_json(const std::vector<render::ObjectName>& objects);

/// Bytes of all grids that the scene has loaded; a grid that several entities share counts once.
std::uint64_t loaded_data_bytes(const scene::Scene& scene);

}  // namespace catena::app

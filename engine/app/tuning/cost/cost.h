/// `catena info --cost`: what a scene, or a data file as `render` shows it, will load, mirror, create, evaluate a tick and draw a frame,
/// with bytes and expected times, and with --measure what was then measured. Bytes are those that the functions that allocate would take.
/// Expected times are counts of work times a unit cost, or sums of parts, which are measured here and now:
///   a formula on its grid   nodes x what a node of the same formula took on a lattice of 64^3
///   a mirror                bytes x what a byte of a mirror of 128^3 took
///   a file                  what loading it took just now
///   a tick                  one without links + what each link adds that is alone in its chain, on a standard walk through the scene
///   a frame                 a start + rows x what a row took: of strips of the picture, some of 1 row and some of 8
/// What has no model has no expected time. Frame thread.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/scene/scene.h"
#include "haptics/chain/program.h"
#include "render/frame/frame_packet.h"

namespace catena::app {

struct ResourceCost {
  std::optional<double> bytes, ms;
};

struct CostRow {
  std::string stage;  ///< load, shape, mirror, create, tick, frame
  std::string name, work;
  ResourceCost expected, measured;
};
using CostTable = std::vector<CostRow>;

/// The fields that the scene has loaded and sampled, by now: each is loaded again from the file of the scene, measured twice.
Outcome add_load_costs(const std::string& path, const scene::Scene& scene, bool measure, CostTable& table);
/// Meshes, curves and tables of points that the scene has loaded, each loaded again as above; and the shapes that a frame draws, traced
/// lines among them, with the bytes that their places take.
Outcome add_shape_costs(const scene::Scene& scene, const render::FramePacket& packet, bool measure, CostTable& table);
/// Links and their fetches on a walk through the box of what is loaded.
void add_tick_costs(const scene::Scene& scene, const haptics::HapticProgram& program, bool measure, CostTable& table);
/// ResidencyManager, passes and a picture of the packet at `balanced`, as that quality stands: without the search that `render` makes for
/// its error. An error is the device's.
Outcome add_frame_costs(const render::FramePacket& packet, bool measure, CostTable& table);

/// Prints the table, or one JSON object on one line.
Outcome print_costs(const std::string& path, bool json, bool measure);

}  // namespace catena::app

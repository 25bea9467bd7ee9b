/// The only door from the scene to the eye: volumes, isosurfaces, meshes, slices, streamline sets, the visible cursor, widgets,
/// background and camera become one frame packet; the ECS is not read after it. Loads (once) only the fields that something drawn names,
/// and takes every streamline from `use_curve`: the drawn tube and the felt link are the same object. Frame thread.
#pragma once
#include <cstdint>

#include "engine/base/result.h"
#include "engine/scene/scene.h"
#include "render/frame/camera.h"
#include "render/frame/frame_packet.h"

namespace catena::render {

/// Errors carry the scene file's name and line: a field that is missing or of the wrong kind, a level that no value attains,
/// a seed that starts nothing.
Result<FramePacket> extract_frame(scene::Scene& scene, std::uint32_t width, std::uint32_t height);

/// Another view of the packet of this scene; what follows from the view, the eyes and the fog's range, is made anew.
void set_view(const scene::Scene& scene, const View& view, FramePacket& packet);

/// The world box of the data that the packet draws, which nothing that the hand moves changes: domains of grids, meshes. Empty without.
Bounds data_bounds(const FramePacket& packet);

/// The world box of all that the packet draws: of the data, tubes, cursors; not of aids and widgets.
Bounds packet_bounds(const FramePacket& packet);

/// Field values to colour and extinction; the scene has filled in what the file leaves out.
///   alpha a over the length u (0: the smallest voxel edge) at a point:  sigma = -ln(1 - a) / u;  between points sigma is linear
TransferTable transfer_table(const scene::TransferFunction& transfer, const field::ScalarField& field);

}  // namespace catena::render

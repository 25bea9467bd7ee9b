// SPDX-License-Identifier: MIT
/// Extraction of frame packets, the only interface between scene and renderer: volumes, isosurfaces, meshes, slices, streamline sets,
/// glyphs, the visible cursor, widgets, background and camera are copied into one packet; the ECS is not read afterwards. Data that must be
/// loaded or built first is built by prepare_frame() and cached in scene.cache; extract_frame() only reads. The rendered tube and the
/// haptic link use the same curve. Frame thread.
#pragma once
#include <cstdint>

#include "engine/base/export.h"
#include "engine/base/result.h"
#include "engine/scene/scene.h"
#include "render/frame/camera.h"
#include "render/frame/frame_packet.h"

namespace catena::render {

/// Runs scene::prepare() and builds the render data: polylines, triangles, grids of vector magnitudes, ruler measurements. An Error gives
/// the scene file's name and line: a missing field, a seed from which no line starts.
CATENA_EXPORT Outcome prepare_frame(scene::Scene& scene);
/// Extracts the packet of a prepared scene. An Error, in the same form, for a field of the wrong kind or a level that no value attains.
CATENA_EXPORT Result<FramePacket> extract_frame(const scene::Scene& scene, std::uint32_t width, std::uint32_t height);
/// Calls prepare_frame() and extract_frame().
CATENA_EXPORT Result<FramePacket> make_frame(scene::Scene& scene, std::uint32_t width, std::uint32_t height);

/// Sets another view in the packet of this scene and updates what depends on the view (the eyes, the edges of the axes, the fog's range,
/// widgets).
CATENA_EXPORT void set_view(const scene::Scene& scene, const View& view, FramePacket& packet);

/// Updates the cursors in the packet of this scene to the current device positions (late latching); everything else, including the cursor
/// size, is unchanged.
CATENA_EXPORT void update_cursors(const scene::Scene& scene, FramePacket& packet);

/// Returns an Error if the image is for a display screen and the packet's camera is not in front of it: it is then rendered as without the
/// screen.
CATENA_EXPORT Outcome check_screen_view(const FramePacket& packet, const scene::Stereo& stereo);

/// Returns the world bounds of the data in the packet, independent of cursors: domains of grids, meshes. Empty if there are none.
CATENA_EXPORT Bounds data_bounds(const FramePacket& packet);

/// Returns the world bounds of all rendered items in the packet: data, tubes, cursors; not environment and widgets.
CATENA_EXPORT Bounds packet_bounds(const FramePacket& packet);

/// Converts a transfer function to colors and extinctions; values that the file leaves out have been filled in by the scene.
///   opacity a over the length u (0: the smallest voxel edge) at a point:  sigma = -ln(1 - a) / u;  between points sigma is linear
CATENA_EXPORT TransferTable make_transfer_table(const scene::TransferFunction& transfer, const field::ScalarField& field);
/// Returns the table for a field that is not null: of the finest level of data that are larger than memory.
CATENA_EXPORT TransferTable make_transfer_table(const scene::TransferFunction& transfer, const field::AnyField& field);

}  // namespace catena::render

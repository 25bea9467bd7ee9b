/// The only door from the scene to the eye: volumes, isosurfaces, meshes, slices, streamline sets, glyphs, the visible cursor, widgets,
/// background and camera become one frame packet; the ECS is not read after it. What has to be loaded or made first, prepare_frame
/// makes, once, and keeps in scene.made; extract_frame only reads. The drawn tube and the felt link are the same curve. Frame thread.
#pragma once
#include <cstdint>

#include "engine/base/result.h"
#include "engine/scene/scene.h"
#include "render/frame/camera.h"
#include "render/frame/frame_packet.h"

namespace catena::render {

/// scene::prepare, and what the eye makes of it: polylines, triangles, grids of magnitudes, measures of rulers. Errors carry the scene
/// file's name and line: a field that is missing, a seed that starts nothing.
Outcome prepare_frame(scene::Scene& scene);
/// Of a scene that is prepared. Errors as before: a field of the wrong kind, a level that no value attains.
Result<FramePacket> extract_frame(const scene::Scene& scene, std::uint32_t width, std::uint32_t height);
/// The two, one after the other.
Result<FramePacket> make_frame(scene::Scene& scene, std::uint32_t width, std::uint32_t height);

/// Another view of the packet of this scene; what follows from the view (the eyes, the edges of the axes, the fog's range) is made anew.
void set_view(const scene::Scene& scene, const View& view, FramePacket& packet);

/// The cursors of the packet of this scene where the hand is by now (late latching): all else, and how large they are, stays.
void update_cursors(const scene::Scene& scene, FramePacket& packet);

/// An Error where the picture is of a screen, and the packet's eye is not before it: it is drawn as without the screen.
Outcome check_screen_view(const FramePacket& packet, const scene::Stereo& stereo);

/// The world box of the data that the packet draws, which nothing that the hand moves changes: domains of grids, meshes. Empty without.
Bounds data_bounds(const FramePacket& packet);

/// The world box of all that the packet draws: of the data, tubes, cursors; not of aids and widgets.
Bounds packet_bounds(const FramePacket& packet);

/// Field values to colour and extinction; the scene has filled in what the file leaves out.
///   alpha a over the length u (0: the smallest voxel edge) at a point:  sigma = -ln(1 - a) / u;  between points sigma is linear
TransferTable make_transfer_table(const scene::TransferFunction& transfer, const field::ScalarField& field);

}  // namespace catena::render

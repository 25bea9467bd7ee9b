/// Private to this room: streamline sets and the local indicator into the packet. Frame thread.
///   tubes       every line of a set is flattened once; with "color_by" each point has a colour: the value there, by the table
///   arrows      cones on the line, "arrows" apart, the seed's in the middle of the first gap
///   pulse       brightness runs along the line: a cosine of period `pulse` in arc length, moved by the scene's phase
///   indicator   the exact tracer's line through the probe, half the length to either side; nothing where the flow has no line
#pragma once
#include "engine/base/result.h"
#include "engine/scene/scene.h"
#include "render/frame/frame_packet.h"

namespace catena::render {

/// Flattens the lines.
Outcome prepare_streamlines(scene::Scene& scene);
void extract_streamlines(const scene::Scene& scene, FramePacket& packet);
/// After the cursors.
Outcome extract_indicators(const scene::Scene& scene, FramePacket& packet);

/// Of scene.made: what a prepared set's "color_by" has come to: its own table, or the one over the values that are drawn. None without
/// "color_by".
const std::vector<scene::TransferFunction::ColorPoint>* shown_colors(const scene::World& made, scene::Entity set);

/// The colour of a value by a table with rising values; its ends beyond them; grey for no number.
Color table_color(const std::vector<scene::TransferFunction::ColorPoint>& table, double value);

}  // namespace catena::render

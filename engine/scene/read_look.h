/// "color_by": colours that follow values, one shape wherever it stands. Inside this room only.
#pragma once
#include "engine/scene/scene_keys.h"
#include "engine/scene/write_values.h"

namespace catena::scene {

/// What is coloured: what rays meet (fields only, never as a word), surfaces (fields), or lines (which know their speed and length, too).
enum class ColorSubjects { rays, surfaces, lines };

Key color_by_key(ColorSubjects subjects);
/// Empty where the item says nothing. A word with the colours' keys beside it, as scenes were written once, is read with a note.
Outcome read_color_by(Scene& scene, const json::Node& item, ColorSubjects subjects, std::optional<ColorBy>& out);
/// "color" and "range" as members.
schema::Members scale_members(const std::vector<TransferFunction::ColorPoint>& colors, const NamedColors& named);

/// A volume's colours and opacities.
schema::Members transfer_members(const TransferFunction& transfer);

}  // namespace catena::scene

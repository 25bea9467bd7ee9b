/// These functions make what "show this field as .." adds to the scene: an item with defaults that show something, as JSON text. Pure, any
/// thread.
#pragma once
#include <string>
#include <vector>

#include "engine/scene/scene.h"

namespace catena::app {

enum class ShowAs { volume, isosurface, slice, streamlines };

/// Where it goes: "/volumes/-" and so on.
std::string pointer_of_new(ShowAs as);
/// "volume" and so on, for the menu of undo.
const char* word_of(ShowAs as);
/// A scalar field as all but streamlines, a vector field as a slice (its magnitude) and streamlines.
bool can_show(const field::AnyField& field, ShowAs as);

/// The isosurface lies where a link of the chain lies on the field, or else half way between the 2nd and the 98th percentile of `sorted`
/// (empty: of the field's range), the slice across z through the middle of the domain, the seeds in a ball around it. `values`: of the
/// field as it is drawn.
std::string new_item(const scene::Scene& scene, scene::Entity field, const field::AnyField& values, ShowAs as,
                     const std::vector<float>& sorted);

}  // namespace catena::app

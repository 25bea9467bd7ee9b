/// Steps in time. A field whose file has several, or whose "file" is a pattern ("wind_*.vti": the files in natural order, 2 before 10),
/// follows the scene's step; one that states a step of its own does not. Beyond a field's last step its last one stands. Frame thread.
#pragma once
#include <string>
#include <vector>

#include "engine/scene/scene.h"

namespace catena::scene {

/// The files that a name with one `*` in its last part stands for, in natural order; empty: none.
std::vector<std::string> files_of_pattern(const std::string& path);
bool is_pattern(const std::string& path);

/// Of the field with most; 1: nothing changes. Steps within a file are known once it is loaded.
int step_count(const Scene& scene);
/// The time of the scene's step, where a file states it.
std::optional<double> time_of_step(const Scene& scene);

/// Fields that follow change their source, and what was made of the scene is dropped. Nothing is loaded. False: nothing changes.
bool set_step(Scene& scene, int step);
/// What the fields that are loaded now will need at that step, so that it can be loaded ahead (engine/field/kept.h).
std::vector<field::LoadRequest> requests_at(const Scene& scene, int step);

/// Private to this room: the source of one field at a step.
void put_step(FieldSource& source, int step);

}  // namespace catena::scene

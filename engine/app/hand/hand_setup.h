/// Before the hand takes hold: how large its world is, and where it begins.
#pragma once
#include "engine/scene/scene.h"
#include "render/frame/camera.h"

namespace catena::app {

/// Fits an unstated workspace: the longest edge of what is there fills the device's reach, centre on centre; and switches
/// ramp in over 20 ms unless the scene says otherwise. `centre_m`: of the device's reach, in its own axes; a stated origin is the
/// world place of that centre. Once for a scene.
void fit_workspace(scene::Scene& scene, const Bounds& bounds, double reach_m, const Vec3& centre_m = Vec3(0.0));

/// The first place of the probe: the scene's cursor, the seed of the first link that has one, or the middle of what is there.
Vec3 first_probe(const scene::Scene& scene, const Bounds& bounds);

/// World -> metres in the device's axes, the inverse of what the servo does:  R^T (p - origin) S
Vec3 device_from_world(const scene::Workspace& workspace, const Vec3& world);

}  // namespace catena::app

// SPDX-License-Identifier: MIT
/// The workload that curves are measured on: one scene, prepared once, with the motion of the probe and the rendered image where it has
/// them.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/app/tuning/measure/curve.h"
#include "engine/base/result.h"
#include "engine/scene/scene.h"
#include "haptics/chain/tick.h"
#include "render/passes/renderer.h"

namespace catena::app::tuning {

/// Limits on the duration of a run.
struct Effort {
  const char* name;  ///< quick, default, thorough
  /// Wall time for the timed runs of one curve of haptics and of one curve of rendering, seconds.
  double haptics_s, rendering_s;
  double motion_s;              ///< Duration of the simulated probe motion, seconds.
  std::uint32_t width, height;  ///< Size of the images, pixels.
  double total_s;               ///< Wall time for all curves together, seconds.
};
/// Returns the effort of a name: quick, default or thorough.
const Effort& select_effort(std::string_view name);
/// Returns `full` with less time for timed runs if the run is late: `done` is the fraction of curves (0 to 1) measured within `elapsed_s`.
Effort reduce_if_late(const Effort& full, double elapsed_s, double done);

/// A link of the scene and its JSON node.
struct NamedLink {
  std::string name;
  json::Node node;
};
/// Returns the scene's links of the given type.
std::vector<NamedLink> find_links(const scene::Scene& scene, const std::string& type);

/// Motion of the probe as a function of time, independent of the tick rate: positions in world units, time in seconds.
struct ProbeMotion {
  std::function<Vec3(double t_s)> position_at;
  /// Pressed buttons, bit by bit; empty function: none.
  std::function<std::uint32_t(double t_s)> buttons_at;
  double seconds = 0;
  std::string description;  ///< Describes the motion in a report.
  /// Returns the samples at the given tick rate.
  std::vector<haptics::ProbeSample> samples(double rate_hz) const;
};

/// Returns the speed of generated motions, world units per second: 0.15 m/s at the device.
double probe_speed(const scene::Scene& scene);

/// Returns the field named by an item of the chain; empty (neither scalar nor vector) if it has none.
field::AnyField find_link_field(scene::Scene& scene, const json::Node& link);

/// Return a motion for one link: along its streamline and slightly off it; through its surface and back. Nothing if the link has no field,
/// or no seed or level to start from. `seconds`: duration.
std::optional<ProbeMotion> motion_along_streamline(scene::Scene& scene, const NamedLink& link, double seconds);
std::optional<ProbeMotion> motion_through_surface(scene::Scene& scene, const NamedLink& link, double seconds);

/// Returns the motion read from `probe_csv`, or if that is empty one that follows the first link: along a streamline and slightly off it,
/// through a surface and back, or else a loop of 4 cm. Generated motions have a speed of 0.15 m/s at the device. An Error if the file
/// cannot be read.
Result<ProbeMotion> make_probe_motion(scene::Scene& scene, const std::string& probe_csv, double seconds);

/// The rendered image of the workload and the reference its errors are measured against.
struct RenderWorkload {
  std::unique_ptr<render::Renderer> renderer;
  render::FramePacket packet;                  ///< Without background, text and cursor.
  bool supports_fast_raycast = false;          ///< Whether the fast raycast can draw the packet.
  bool has_raycast = false;                    ///< Whether anything is sampled along rays, so that the ray step changes the image.
  render::Image8 reference;                    ///< Converged image of `packet`.
  double reference_step = 0;                   ///< Ray step of the reference, voxels.
  double reference_error = kNotMeasured;       ///< Change from the last halving of the ray step, RMSE in 1/255.
  double discretization_error = kNotMeasured;  ///< Discretization error in the image, RMSE in 1/255.
  bool discretization_error_converged = true;  ///< False: it is a lower bound.
  std::string discretization_error_method;     ///< How it was estimated.
};

/// One scene with everything that a measurement needs.
struct Workload {
  scene::Scene scene;
  Effort effort;
  std::shared_ptr<const haptics::HapticProgram> program;  ///< Null: no haptics to measure.
  ProbeMotion motion;
  /// Tick rate of the servo, Hz.
  double rate_hz = 1000;
  std::unique_ptr<RenderWorkload> rendering;  ///< Null: no rendering to measure.
  std::vector<std::string> skipped;           ///< Skipped measurements with the reason, a sentence each.
};

/// Sets program, motion and rate from a prepared scene, and fits its workspace if the scene does not state one. For a scene without a chain
/// it only adds a sentence to Workload::skipped. An Error if the device settings, the chain or `probe_csv` are invalid.
Outcome add_haptics(Workload& subject, const std::string& probe_csv);

}  // namespace catena::app::tuning

/// What the curves are measured on: one scene, made ready once, with the hand's motion and the eye's picture where it has them.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/app/tuning/tradeoff/measure/curve.h"
#include "engine/base/result.h"
#include "engine/scene/scene.h"
#include "haptics/chain/tick.h"
#include "render/passes/renderer.h"

namespace catena::app::tradeoff {

/// How much time a run may take.
struct Effort {
  const char* name;               ///< quick, default, thorough
  double haptics_s, rendering_s;  ///< of a curve of the hand, of the eye: wall time for its repeats
  double motion_s;                ///< of the hand's motion, simulated
  std::uint32_t width, height;    ///< of the pictures
  double total_s;                 ///< of all curves together
};
const Effort& select_effort(bool quick, bool thorough);
/// `whole`, with less time for repeats where a run is late: after `elapsed_s` a share `done` (0 to 1) of its curves is measured.
Effort reduce_if_late(const Effort& whole, double elapsed_s, double done);

/// The scene's links of a type.
struct NamedLink {
  std::string name;
  json::Node node;
};
std::vector<NamedLink> find_links(const scene::Scene& scene, const std::string& type);

/// Where the hand goes, at any rate: world units by seconds.
struct ProbeMotion {
  std::function<Vec3(double t_s)> position_at;
  std::function<std::uint32_t(double t_s)> buttons_at;
  double seconds = 0;
  std::string description;  ///< what it does
  std::vector<haptics::ProbeSample> samples(double rate_hz) const;
};

/// Of the hand's own motions, world units a second: 0.15 m/s.
double probe_speed(const scene::Scene& scene);

/// The field that an item of the chain names; neither kind where there is none.
field::AnyField find_link_field(scene::Scene& scene, const json::Node& link);

/// Where a link is followed: along its streamline and a little beside it; through its surface and back. Nothing where it has none.
std::optional<ProbeMotion> motion_along_streamline(scene::Scene& scene, const NamedLink& link, double seconds);
std::optional<ProbeMotion> motion_through_surface(scene::Scene& scene, const NamedLink& link, double seconds);

/// A path of the user's own, or else one that follows the first link: along a streamline and a little beside it, through a surface and
/// back, or a loop of 4 cm. At 0.15 m/s of the hand.
Result<ProbeMotion> make_probe_motion(scene::Scene& scene, const std::string& probe_csv, double seconds);

/// The eye's picture and what its errors are measured against.
struct RenderWorkload {
  std::unique_ptr<render::Renderer> renderer;
  render::FramePacket packet;                  ///< without a background, texts and cursor
  bool supports_fast_raycast = false;          ///< the fast raycast can draw it
  bool has_raycast = false;                    ///< anything is sampled along rays: their step changes the picture
  render::Image8 reference;                    ///< converged; of `packet`
  double reference_step = 0;                   ///< voxels
  double reference_error = kNotMeasured;       ///< what halving the step still changed, RMSE
  double discretization_error = kNotMeasured;  ///< the data's own error in the picture, RMSE
  bool discretization_error_converged = true;  ///< false: at least
  std::string discretization_error_method;
};

struct Workload {
  scene::Scene scene;
  Effort effort;
  std::shared_ptr<const haptics::HapticProgram> program;  ///< none: no hand
  ProbeMotion motion;
  double rate_hz = 1000;
  std::unique_ptr<RenderWorkload> rendering;  ///< none: no pictures
  std::vector<std::string> skipped;           ///< what was not measured, and why: a sentence each
};

/// HapticProgram, motion and rate of a scene that is prepared; fits an unstated workspace. A scene without a chain gets none of it, and a
/// sentence in left_out.
Outcome add_haptics(Workload& subject, const std::string& probe_csv);

}  // namespace catena::app::tradeoff

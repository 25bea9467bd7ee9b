/// What the curves are measured on: one scene, made ready once, with the hand's motion and the eye's picture where it has them.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/app/tradeoff/measure/curve.h"
#include "engine/base/result.h"
#include "engine/scene/scene.h"
#include "haptics/chain/tick.h"
#include "render/passes/renderer.h"

namespace catena::app::tradeoff {

/// How much time a run may take.
struct Effort {
  const char* word;             ///< quick, default, thorough
  double hand_s, eye_s;         ///< of a curve of the hand, of the eye: wall time for its repeats
  double motion_s;              ///< of the hand's motion, simulated
  std::uint32_t width, height;  ///< of the pictures
  double run_s;                 ///< of all curves together
};
const Effort& effort(bool quick, bool thorough);
/// `whole`, with less time for repeats where a run is late: after `elapsed_s` a share `done` (0 to 1) of its curves is measured.
Effort in_time(const Effort& whole, double elapsed_s, double done);

/// The scene's links of a type.
struct LinkOf {
  std::string name;
  json::Node node;
};
std::vector<LinkOf> links_of_type(const scene::Scene& scene, const std::string& type);

/// Where the hand goes, at any rate: world units by seconds.
struct Motion {
  std::function<Vec3(double t_s)> at;
  std::function<std::uint32_t(double t_s)> buttons;
  double seconds = 0;
  std::string words;  ///< what it does
  std::vector<haptics::ProbeSample> samples(double rate_hz) const;
};

/// Of the hand's own motions, world units a second: 0.15 m/s.
double hand_speed(const scene::Scene& scene);

/// The field that an item of the chain names; neither kind where there is none.
field::AnyField field_of(scene::Scene& scene, const json::Node& link);

/// Where a link is followed: along its streamline and a little beside it; through its surface and back. Nothing where it has none.
std::optional<Motion> along_streamline(scene::Scene& scene, const LinkOf& link, double seconds);
std::optional<Motion> through_surface(scene::Scene& scene, const LinkOf& link, double seconds);

/// A path of the user's own, or else one that follows the first link: along a streamline and a little beside it, through a surface and
/// back, or a loop of 4 cm. At 0.15 m/s of the hand.
Result<Motion> make_motion(scene::Scene& scene, const std::string& probe_csv, double seconds);

/// The eye's picture and what its errors are measured against.
struct Eye {
  std::unique_ptr<render::Renderer> renderer;
  render::FramePacket packet;         ///< without a background, texts and cursor
  bool fast = false;                  ///< the fast raycast can draw it
  bool rays = false;                  ///< anything is sampled along rays: their step changes the picture
  render::Picture truth;              ///< converged; of `packet`
  double truth_step = 0;              ///< voxels
  double truth_error = kNotMeasured;  ///< what halving the step still changed, RMSE
  double floor = kNotMeasured;        ///< the data's own error in the picture, RMSE
  bool floor_settled = true;          ///< false: at least
  std::string floor_from;
};

struct Subject {
  scene::Scene scene;
  Effort effort;
  std::shared_ptr<const haptics::Program> program;  ///< none: no hand
  Motion motion;
  double rate_hz = 1000;
  std::unique_ptr<Eye> eye;           ///< none: no pictures
  std::vector<std::string> left_out;  ///< what was not measured, and why: a sentence each
};

/// Program, motion and rate of a scene that is prepared; fits an unstated workspace. A scene without a chain gets none of it, and a
/// sentence in left_out.
Outcome add_hand(Subject& subject, const std::string& probe_csv);

}  // namespace catena::app::tradeoff

#include "render/quality/quality.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "engine/base/clock.h"
#include "render/quality/refinement.h"

namespace catena::render {
namespace {

constexpr double kStepShare = 0.93;  // of the error that ray steps may take
constexpr double kMargin = 0.95;     // for the lattice's statistical error
constexpr int kMaxPictures = 16;

/// How rays become a picture. Refinement thresholds in shares of the error; costs by those of marching every pixel at step 1, as a
/// CPU driver has them: they only decide what is tried first.
struct Plan {
  std::uint32_t spacing;
  double refine_half, refine_full;
  double overhead, rays;
};
constexpr Plan kPlan[] = {{4, -1, -1, 0.02, 0.1},   {4, 2, -1, 0.03, 0.16},  {4, 1.3, -1, 0.03, 0.19},
                          {4, 0.8, -1, 0.03, 0.24}, {2, 0, -1, 0.02, 0.3},   {4, 1, 3, 0.05, 0.28},
                          {2, 0, 2, 0.06, 0.45},    {2, 0, 0.8, 0.06, 0.65}, {1, 0, -1, 0.03, 1}};
constexpr int kPlans = int(std::size(kPlan));
constexpr double kFastSteps[] = {8, 6, 5, 4, 3, 2, 1.5, 1, 0.5};
constexpr double kExactSteps[] = {4, 2, 1, 0.5, 0.25};

RenderSettings exact(double step_voxels) {
  RenderSettings s;
  s.step_voxels = step_voxels;
  if (step_voxels < 1) s.termination = 1e-3;
  return s;
}

RenderSettings fast(double step_voxels, std::uint32_t spacing, double refine_half_255, double refine_full_255) {
  RenderSettings s;
  s.fast = FastSettings{step_voxels, spacing, refine_half_255, refine_full_255};
  return s;
}

/// As `reference`, but for the texels.
RenderSettings converged() {
  RenderSettings s = exact(0.1);
  s.termination = 1e-4;
  return s;
}

double rmse(const Picture& a, const Picture& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.rgba.size(); ++i)
    if (i % 4 != 3) sum += (double(a.rgba[i]) - b.rgba[i]) * (double(a.rgba[i]) - b.rgba[i]);
  return std::sqrt(sum / (0.75 * double(a.rgba.size())));
}

/// The lattice's pixels of a finished picture, over black.
Picture on_lattice(const Picture& picture) {
  const std::uint32_t spacing = probe_spacing(picture.width, picture.height);
  Picture out;
  out.width = (picture.width + spacing - 1) / spacing;
  out.height = (picture.height + spacing - 1) / spacing;
  for (std::uint32_t y = 0; y < picture.height; y += spacing)
    for (std::uint32_t x = 0; x < picture.width; x += spacing) {
      const std::uint8_t* p = picture.pixel(x, y);
      for (int c = 0; c < 3; ++c) out.rgba.push_back(std::uint8_t(std::lround(p[c] * (p[3] / 255.0))));
      out.rgba.push_back(255);
    }
  return out;
}

class Search {
 public:
  Search(Renderer& renderer, const FramePacket& packet) : renderer_(renderer), packet_(packet) {}

  Outcome begin() {
    CATENA_TRY(truth_, renderer_.probe(packet_, converged()));
    if (!renderer_.draws_fast(packet_)) return Done{};
    // it may have no memory for the grid
    CATENA_TRY(const double rays, of_rays(fast(8, 1, 0, -1)));
    (void)rays;
    fast_ = renderer_.draws_fast(packet_);
    return Done{};
  }

  /// Of the rays alone.
  Result<double> of_rays(const RenderSettings& settings) {
    CATENA_TRY(const Picture rays, renderer_.probe(packet_, settings));
    return rmse(rays, truth_);
  }

  /// Of the finished picture.
  Result<double> of_picture(const RenderSettings& settings) {
    CATENA_CHECK(renderer_.draw(packet_, settings));
    ++pictures_;
    CATENA_TRY(const Picture picture, renderer_.read_back());
    return rmse(on_lattice(picture), truth_);
  }

  Result<QualityChoice> for_error(double e) {
    if (fast_) {
      CATENA_TRY(auto candidates, fast_candidates(e));
      std::optional<Tried> failed[kPlans][2];  // the latest of a plan and shading
      for (int drawn = 0; drawn < kMaxPictures && !candidates.empty(); candidates.erase(candidates.begin())) {
        // what interpolation cost at another step says whether this one is worth a picture
        const Candidate& next = candidates.front();
        std::optional<Tried>& before = failed[next.plan][next.smooth];
        if (before && std::hypot(next.rays, before->interpolation) > e) continue;
        CATENA_TRY(const double picture, of_picture(next.settings));
        ++drawn;
        if (picture <= kMargin * e) return choice(next.settings, picture, true);
        before = Tried{std::sqrt(std::max(0.0, picture * picture - next.rays * next.rays))};
      }
    }
    for (const double step : kExactSteps) {
      CATENA_TRY(const double rays, of_rays(exact(step)));
      if (rays <= kMargin * e) return choice(exact(step), rays, true);
    }
    return choice(reference_settings(), 0, true);
  }

  Result<QualityChoice> for_time(double ms, const DrawTimer& timer) {
    const bool shaded = std::any_of(packet_.volumes.begin(), packet_.volumes.end(), [](const VolumeItem& item) { return item.shade; });
    std::vector<RenderSettings> settings;
    std::vector<TimedPicture> tried;
    for (const RenderSettings& next : quality_ladder({fast_, shaded})) {
      // the first picture pays for pipelines and mirrors
      CATENA_TRY(const double error, of_picture(next));
      CATENA_TRY(const double took, timer ? timer(next) : slower_of_two(next));
      settings.push_back(next);
      tried.push_back({took, error});
      if (took > ms) break;
    }
    const std::size_t best = best_within(tried, ms);
    QualityChoice chosen = choice(settings[best], tried[best].rmse, tried[best].ms <= ms);
    chosen.expected_ms = tried[best].ms;
    return chosen;
  }

 private:
  struct Candidate {
    RenderSettings settings;
    double rays, cost;
    int plan;
    bool smooth;
  };
  struct Tried {
    double interpolation;
  };

  /// Every step whose rays alone are good enough with every plan of interpolation, the cheapest first.
  Result<std::vector<Candidate>> fast_candidates(double e) {
    std::vector<Candidate> all;
    const bool shade = packet_.volumes.front().shade;
    for (const bool smooth : {false, true}) {
      if (smooth && !shade) continue;
      for (const double step : kFastSteps) {
        RenderSettings settings = fast(step, 1, 0, -1);
        settings.fast->smooth_gradients = smooth;
        CATENA_TRY(const double rays, of_rays(settings));
        if (rays > kStepShare * e) continue;
        for (int plan = 0; plan < kPlans; ++plan) {
          const Plan& p = kPlan[plan];
          RenderSettings planned = fast(step, p.spacing, p.refine_half * e, p.refine_full * e);
          planned.fast->smooth_gradients = smooth;
          all.push_back({planned, rays, p.overhead + p.rays * (smooth ? 1.8 : 1.0) / step, plan, smooth});
        }
      }
    }
    std::stable_sort(all.begin(), all.end(), [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; });
    return all;
  }

  Result<double> slower_of_two(const RenderSettings& settings) {
    double slower = 0;
    for (int k = 0; k < 2; ++k) {
      const std::int64_t start = now_ns();
      CATENA_CHECK(renderer_.draw(packet_, settings));
      slower = std::max(slower, ms_since(start));
    }
    return slower;
  }

  QualityChoice choice(const RenderSettings& settings, double error, bool reached) const {
    return {settings, error, 0, reached, pictures_};
  }

  Renderer& renderer_;
  const FramePacket& packet_;
  Picture truth_;
  bool fast_ = false;
  int pictures_ = 0;
};

/// The packet as its first eye sees it.
FramePacket first_eye(const FramePacket& packet) {
  FramePacket one = packet;
  one.view = packet.eyes.front();
  one.eyes.clear();
  one.packing = Packing::single;
  return one;
}

}  // namespace

std::size_t best_within(const std::vector<TimedPicture>& tried, double ms) {
  CATENA_ASSERT(!tried.empty());
  std::size_t best = 0;
  const auto better = [ms](const TimedPicture& a, const TimedPicture& b) {
    if ((a.ms <= ms) != (b.ms <= ms)) return a.ms <= ms;
    return a.ms <= ms ? a.rmse < b.rmse : a.ms < b.ms;
  };
  for (std::size_t i = 1; i < tried.size(); ++i)
    if (better(tried[i], tried[best])) best = i;
  return best;
}

Result<QualityChoice> choose_quality(Renderer& renderer, const FramePacket& packet, const QualityGoal& goal, DrawTimer timer) {
  if (!packet.eyes.empty()) {
    const double share = goal.kind == QualityGoal::Kind::time ? double(packet.eyes.size()) : 1;
    return choose_quality(renderer, first_eye(packet), {goal.kind, goal.value / share}, timer);
  }
  Search search(renderer, packet);
  CATENA_CHECK(search.begin());
  return goal.kind == QualityGoal::Kind::error ? search.for_error(goal.value) : search.for_time(goal.value, timer);
}

Result<double> estimate_rmse(Renderer& renderer, const FramePacket& packet, const RenderSettings& settings) {
  if (!packet.eyes.empty()) return estimate_rmse(renderer, first_eye(packet), settings);
  Search search(renderer, packet);
  CATENA_CHECK(search.begin());
  return search.of_picture(settings);
}

std::string describe(const RenderSettings& settings) {
  if (!settings.fast) return fmt::format("exact, step {:g}", settings.step_voxels);
  const FastSettings& f = *settings.fast;
  std::string text = fmt::format("fast, step {:g}", f.step_voxels);
  if (f.smooth_gradients) text += ", smooth gradients";
  if (f.spacing > 1) text += fmt::format(", every {} pixel", f.spacing == 2 ? "2nd" : "4th");
  if (f.spacing == 4 && f.refine_half_255 >= 0) text += fmt::format(", every 2nd above {:.2g}", f.refine_half_255);
  if (f.spacing > 1 && f.refine_full_255 >= 0) text += fmt::format(", every pixel above {:.2g}", f.refine_full_255);
  return text;
}

}  // namespace catena::render

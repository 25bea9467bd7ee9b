#include "render/quality/quality.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>

#include "engine/base/numbers.h"
#include "render/image/measure.h"
#include "render/quality/refinement.h"

namespace catena::render {
namespace {

constexpr double kStepShare = 0.93;                             // of the error that ray steps may take
constexpr double kDeviations = 2;                               // of the lattice's mean, that an estimate lies above it
constexpr double kFarthest = 8;                                 // the 99.9 percentile, in errors
constexpr double kThinGoal = 6;                                 // a thin part may lose that share of the error
constexpr double kFlickerGoal = 0.5;                            // the flicker, in errors, or in what the picture itself changes by
constexpr double kTurn = 0.2;                                   // degrees a frame, which flicker is measured at
constexpr double kSamples = 6000;                               // covered pixels on the lattice
constexpr std::uint32_t kSpacings[] = {13, 11, 9, 7, 5, 3, 1};  // pixels; odd, so that no lattice of rays is met alone
constexpr double kRoughGoal = 1.5;                              // 1/255: from it on the error of step 0.25 does not count
// steps, voxels: of what is seen, the shortest that is chosen, and those of the converged picture, which is halved until the picture
// changes by less than a share of the goal, or by what rounding to 8 bits makes of nothing
constexpr double kSeenStep = 1, kRoughTruthStep = 0.5, kTruthStep = 0.25, kLeastTruthStep = 0.03, kTruthShare = 0.3, kFinestStep = 0.05;
constexpr int kMaxPictures = 16;
constexpr std::size_t kGoodSteps = 5;  // of those that are good enough, the longest

/// How rays become a picture. Refinement thresholds in shares of the error; then the rays of every 2nd pixel and of every pixel that are
/// refined, by all such that show something: guesses, until one was drawn.
struct Plan {
  std::uint32_t spacing;
  double refine_half, refine_full;
  std::array<double, 2> refined;
};
constexpr Plan kPlan[] = {{4, -1, -1, {0, 0}},  {4, 1.3, -1, {0.4, 0}}, {2, 0, -1, {0, 0}},     {4, 1, 3, {0.45, 0.1}},
                          {2, 0, 2, {0, 0.15}}, {2, 0, 1.5, {0, 0.22}}, {2, 0, 0.8, {0, 0.37}}, {1, 0, -1, {0, 0}}};
constexpr int kPlans = int(std::size(kPlan));
/// Of every pixel's rays by those of the first lattice, and of a refined share: a ray costs the more the farther its neighbours are. As a
/// CPU driver has it: it only decides between settings that are good enough.
double cost_of(const Plan& plan, const std::array<double, 2>& refined, double step) {
  const double first = plan.spacing == 1 ? 1 : plan.spacing == 2 ? 0.325 : 0.137;
  const double marks = plan.refine_full >= 0 ? 0.02 : 0;
  return (first + marks + 0.29 * refined[0] + refined[1]) * (kStepless + (1 - kStepless) / step);
}
constexpr double kFastSteps[] = {8, 6, 4, 3, 2, 1.5, 1.2, 1, 0.85, 0.7, 0.6, 0.5, 0.42, 0.35, 0.25, 0.18, 0.125};
constexpr double kExactSteps[] = {4, 2, 1, 0.5, 0.25, 0.125};

/// Errors on the lattice.
struct Measured {
  double rmse = 0;   ///< over the covered pixels
  double above = 0;  ///< the true one is at most so, but in one of forty pictures
  double p999 = 0;   ///< of the largest of a pixel's differences
  bool good_for(double e) const { return above <= e && p999 <= kFarthest * e; }
};

Measured compare(const Picture& a, const Picture& b) {
  PixelErrors errors = covered_errors(a, b);
  const auto count = double(errors.squares.size());
  if (count == 0) return {};
  double sum = 0, squares = 0;
  for (const double here : errors.squares) {
    sum += here;
    squares += here * here;
  }
  const double mean = sum / count, variance = std::max(0.0, squares / count - mean * mean);
  return {std::sqrt(mean), std::sqrt(mean + kDeviations * std::sqrt(variance / count)), quantile(errors.largest, 0.999)};
}

/// The same seen by a camera that has gone a little around its target.
FramePacket turned(const FramePacket& packet) {
  FramePacket out = packet;
  const Vec3 turn = direction(packet.view.up) * (kTurn * std::numbers::pi / 180);
  out.view.position = packet.view.target + rotate(rotation_of(turn), packet.view.position - packet.view.target);
  return out;
}

/// The lattice's pixels of a finished picture.
Picture on_lattice(const Picture& picture, std::uint32_t spacing) {
  Picture out;
  out.width = (picture.width + spacing - 1) / spacing;
  out.height = (picture.height + spacing - 1) / spacing;
  for (std::uint32_t y = 0; y < picture.height; y += spacing)
    for (std::uint32_t x = 0; x < picture.width; x += spacing)
      out.rgba.insert(out.rgba.end(), picture.pixel(x, y), picture.pixel(x, y) + 4);
  return out;
}

class Search {
 public:
  /// The picture is drawn without a background, so that it says what it covers, and without what is written over it, which rays lack.
  Search(Renderer& renderer, const FramePacket& packet) : renderer_(renderer), packet_(packet) {
    packet_.background[3] = 0;
    packet_.overlay = {};
  }

  /// `goal`: the least error that matters, 1/255. `moves`: the error is wanted to be steady, too.
  Outcome begin(double goal, bool moves = false) {
    // exact rays come first: what a large grid needs for them and for the fast raycast is not held at once
    CATENA_TRY(const Picture seen, renderer_.probe(packet_, exact_rung(kSeenStep), kSpacings[0]));
    double covered = 0;
    for (std::size_t i = 3; i < seen.rgba.size(); i += 4) covered += seen.rgba[i] > 0;
    covered *= double(packet_.width) * packet_.height / (double(seen.rgba.size()) / 4);
    covered_ = std::max(1.0, covered);
    for (const std::uint32_t spacing : kSpacings) {
      spacing_ = spacing;
      if (covered / (spacing * spacing) >= kSamples) break;
    }
    CATENA_CHECK(find_truth(renderer_.draws_fast(packet_) ? goal : 0));
    if (moves && renderer_.draws_fast(packet_)) {
      CATENA_TRY(next_truth_, renderer_.probe(turned(packet_), converged_rung(truth_step_), spacing_));
      const Picture none{truth_.width, truth_.height, std::vector<std::uint8_t>(truth_.rgba.size())};
      most_flicker_ = kFlickerGoal * std::max(goal, flicker_between(none, truth_, none, next_truth_));
    }
    if (!renderer_.draws_fast(packet_)) return Done{};
    // it may have no memory for the grid
    CATENA_CHECK(renderer_.probe(packet_, fast_rung(kSeenStep, 1, 0, -1), kSpacings[0]));
    fast_ = renderer_.draws_fast(packet_);
    return Done{};
  }

  double truth_error() const { return truth_error_; }

  /// Of the rays alone.
  Result<Measured> of_rays(const RenderSettings& settings) {
    CATENA_TRY(const Picture rays, renderer_.probe(packet_, settings, spacing_));
    return compare(rays, truth_);
  }

  /// Of the finished picture.
  Result<Measured> of_picture(const RenderSettings& settings) {
    CATENA_CHECK(renderer_.draw(packet_, settings));
    ++pictures_;
    CATENA_TRY(drawn_, drawn_lattice());
    return compare(drawn_, truth_);
  }

  Result<QualityChoice> for_error(double e) {
    if (fast_) {
      CATENA_TRY(const std::optional<QualityChoice> chosen, fast_for_error(e));
      if (chosen) return *chosen;
    }
    for (const double step : kExactSteps) {
      // they are judged by what is finer than they are
      if (step < 2 * truth_step_) break;
      CATENA_TRY(const Measured rays, of_rays(exact_rung(step)));
      if (rays.good_for(e)) return choice(exact_rung(step), rays.above, true);
    }
    RenderSettings finest = reference_settings();
    finest.step_voxels = std::clamp(truth_step_, kFinestStep, finest.step_voxels);
    return choice(finest, truth_error_, truth_error_ <= e);
  }

  /// The cheapest of the fast settings that are good enough; nothing where none is.
  Result<std::optional<QualityChoice>> fast_for_error(double e) {
    CATENA_TRY(std::vector<Candidate> candidates, fast_candidates(e));
    std::array<double, 2> refined[kPlans];
    for (int plan = 0; plan < kPlans; ++plan) refined[plan] = kPlan[plan].refined;
    std::optional<double> failed[kPlans];  // what interpolation cost the latest of a plan
    bool blurs[kPlans] = {};               // what is thin
    // every ray of the longest step: that is good enough as it was measured
    std::optional<QualityChoice> best;
    double best_cost = std::numeric_limits<double>::infinity();
    const auto cost = [&](const Candidate& c) { return cost_of(kPlan[c.plan], refined[c.plan], c.settings.fast->step_voxels); };
    std::erase_if(candidates, [&](const Candidate& c) {
      if (c.settings.fast->spacing > 1) return false;
      if (cost(c) < best_cost) best = choice(c.settings, c.above, true), best_cost = cost(c);
      return true;
    });
    for (int drawn = 0; !candidates.empty() && drawn < kMaxPictures;) {
      const auto cheapest = std::ranges::min_element(candidates, {}, cost);
      const Candidate next = *cheapest;
      candidates.erase(cheapest);
      if (cost(next) >= best_cost) break;
      // what interpolation cost at another step says whether this one is worth a picture
      std::optional<double>& before = failed[next.plan];
      if (blurs[next.plan] || (before && std::hypot(next.rays, *before) > e)) continue;
      CATENA_TRY(const Measured picture, of_picture(next.settings));
      ++drawn;
      CATENA_TRY(const auto rays, renderer_.refined_rays());
      learn(next.plan, {4 * double(rays[0]) / covered_, double(rays[1]) / covered_}, refined);
      if (picture.good_for(e)) {
        if (cost(next) >= best_cost) continue;
        CATENA_TRY(const bool keeps, keeps_what_is_thin(next.settings, e));
        CATENA_TRY(const bool steady, keeps ? is_steady(next.settings) : false);
        if (steady) best = choice(next.settings, picture.above, true), best_cost = cost(next);
        if (keeps) continue;
      }
      // where a few pixels are far off, or what is thin is lost, a shorter step will not mend it: rays alone were good enough
      blurs[next.plan] = picture.above <= e;
      before = std::sqrt(std::max(0.0, picture.above * picture.above - next.rays * next.rays));
    }
    if (best) best->pictures = pictures_;
    return best;
  }

  Result<QualityChoice> for_time(double ms, const DrawTimer& timer) {
    const bool shaded = std::any_of(packet_.volumes.begin(), packet_.volumes.end(), [](const VolumeItem& item) { return item.shade; });
    std::vector<RenderSettings> settings;
    std::vector<TimedPicture> tried;
    for (const RenderSettings& next : quality_ladder({fast_, shaded})) {
      // the first picture pays for pipelines and mirrors
      CATENA_TRY(const Measured error, of_picture(next));
      CATENA_TRY(const double took, timer ? timer(next) : quicker_of_two(next));
      settings.push_back(next);
      tried.push_back({took, error.above});
      if (took > ms) break;
    }
    const std::size_t best = best_within(tried, ms);
    QualityChoice chosen = choice(settings[best], tried[best].rmse, tried[best].ms <= ms);
    chosen.expected_ms = tried[best].ms;
    return chosen;
  }

 private:
  /// Opaque things of steep transfer functions want far shorter steps than haze does.
  Outcome find_truth(double goal) {
    RenderSettings converged = converged_rung(goal < kRoughGoal ? kTruthStep : kRoughTruthStep);
    CATENA_TRY(truth_, renderer_.probe(packet_, converged, spacing_));
    do {
      converged.step_voxels /= 2;
      CATENA_TRY(Picture finer, renderer_.probe(packet_, converged, spacing_));
      truth_error_ = compare(truth_, finer).rmse;
      truth_ = std::move(finer);
    } while (truth_error_ > std::max(kLeastTold, kTruthShare * goal) && converged.step_voxels > kLeastTruthStep);
    truth_step_ = converged.step_voxels;
    return Done{};
  }

  /// Whether interpolation between rays leaves what is thin, and far enough up in the tail of errors, in the picture that was drawn last.
  Result<bool> keeps_what_is_thin(const RenderSettings& settings, double e) {
    if (settings.fast->spacing == 1) return true;
    CATENA_TRY(const Picture picture, renderer_.read_back());
    const double step = std::min(1.0, settings.fast->step_voxels);
    if (step != all_rays_step_) {
      CATENA_CHECK(renderer_.draw(packet_, fast_rung(step, 1, 0, -1, settings.fast->smooth_gradients)));
      CATENA_TRY(all_rays_, renderer_.read_back());
      all_rays_step_ = step;
      ++pictures_;
    }
    const PictureError error = measure_error(picture, all_rays_, {packet_.background[0], packet_.background[1], packet_.background[2]});
    return error.least_kept >= 1 - e / kThinGoal && error.p999 <= kFarthest * e;
  }

  /// Of the picture that was drawn last.
  Result<Picture> drawn_lattice() {
    CATENA_TRY(const Picture picture, renderer_.read_back());
    const std::array<float, 4>& b = packet_.background;
    return over(on_lattice(picture, spacing_), {b[0], b[1], b[2]});
  }

  /// Whether the error of the picture that was drawn last stays much the same where the camera goes on.
  Result<bool> is_steady(const RenderSettings& settings) {
    CATENA_CHECK(renderer_.draw(turned(packet_), settings));
    ++pictures_;
    CATENA_TRY(const Picture after, drawn_lattice());
    return flicker_between(drawn_, truth_, after, next_truth_) <= most_flicker_;
  }

  struct Candidate {
    RenderSettings settings;
    double rays, above;  ///< of the rays alone: Measured
    int plan;
  };

  /// What a plan's picture refined; stricter plans refine no less.
  static void learn(int plan, const std::array<double, 2>& found, std::array<double, 2> (&refined)[kPlans]) {
    refined[plan] = found;
    const Plan& p = kPlan[plan];
    for (int other = 0; other < kPlans; ++other) {
      const Plan& o = kPlan[other];
      if (o.refine_half > 0 && o.refine_half < p.refine_half) refined[other][0] = std::max(refined[other][0], found[0]);
      if (o.refine_full > 0 && o.refine_full < p.refine_full) refined[other][1] = std::max(refined[other][1], found[1]);
    }
  }

  /// The longest steps whose rays alone are good enough, and steady, with every plan of interpolation.
  Result<std::vector<Candidate>> fast_candidates(double e) {
    std::vector<Candidate> all;
    const bool smooth = packet_.volumes.front().shade;
    for (const double step : kFastSteps) {
      if (all.size() == kGoodSteps * std::size(kPlan)) break;
      const RenderSettings every_ray = fast_rung(step, 1, 0, -1, smooth);
      CATENA_TRY(const Picture rays, renderer_.probe(packet_, every_ray, spacing_));
      const Measured error = compare(rays, truth_);
      if (error.rmse > kStepShare * e || error.p999 > kFarthest * e) continue;
      CATENA_TRY(const Picture after, renderer_.probe(turned(packet_), every_ray, spacing_));
      if (flicker_between(rays, truth_, after, next_truth_) > most_flicker_) continue;
      for (int plan = 0; plan < kPlans; ++plan) {
        const Plan& p = kPlan[plan];
        all.push_back({fast_rung(step, p.spacing, p.refine_half * e, p.refine_full * e, smooth), error.rmse, error.above, plan});
      }
    }
    return all;
  }

  Result<double> quicker_of_two(const RenderSettings& settings) {
    CATENA_TRY(const double first, drawing_ms(renderer_, packet_, settings));
    CATENA_TRY(const double second, drawing_ms(renderer_, packet_, settings));
    return std::min(first, second);
  }

  QualityChoice choice(const RenderSettings& settings, double error, bool reached) const {
    return {settings, error, 0, reached, pictures_};
  }

  Renderer& renderer_;
  FramePacket packet_;
  Picture truth_, next_truth_;               ///< the rays of the lattice; and from where the camera goes
  double most_flicker_ = 0;                  ///< that is steady enough
  double covered_ = 1;                       ///< pixels
  Picture drawn_;                            ///< the lattice of the picture that was drawn last
  double truth_step_ = 0, truth_error_ = 0;  ///< and what it still changed by
  Picture all_rays_;                         ///< the fast raycast's without interpolation
  double all_rays_step_ = 0;
  std::uint32_t spacing_ = 1;
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

Result<QualityChoice> choose_quality(Renderer& renderer, const FramePacket& packet, const QualityGoal& goal, const DrawTimer& timer) {
  if (!packet.eyes.empty()) {
    const double share = goal.kind == QualityGoal::Kind::time ? double(packet.eyes.size()) : 1;
    return choose_quality(renderer, first_eye(packet), {goal.kind, goal.value / share}, timer);
  }
  if (!draws_rays(packet)) return QualityChoice{balanced_settings(), 0, 0, true, 0};
  Search search(renderer, packet);
  const bool has_error = goal.kind == QualityGoal::Kind::error;
  CATENA_CHECK(search.begin(has_error ? goal.value : 0, has_error));
  return has_error ? search.for_error(goal.value) : search.for_time(goal.value, timer);
}

Result<double> estimate_rmse(Renderer& renderer, const FramePacket& packet, const RenderSettings& settings) {
  if (!packet.eyes.empty()) return estimate_rmse(renderer, first_eye(packet), settings);
  if (!draws_rays(packet)) return 0.0;
  Search search(renderer, packet);
  // what is coarse is told from a truth that is quicker to have
  CATENA_CHECK(search.begin(settings.fast && settings.fast->step_voxels >= 1 ? kRoughGoal : 0));
  CATENA_TRY(const Measured error, search.of_picture(settings));
  return error.above;
}

Result<MeasuredSettings> measure_rmse(Renderer& renderer, const FramePacket& packet, const std::vector<RenderSettings>& settings,
                                      const std::function<bool(double last)>& go_on) {
  if (!packet.eyes.empty()) return measure_rmse(renderer, first_eye(packet), settings, go_on);
  MeasuredSettings all;
  Search search(renderer, packet);
  CATENA_CHECK(search.begin(kLeastTold));
  all.reference_rmse = search.truth_error();
  for (const RenderSettings& next : settings) {
    if (!go_on(all.rmse.empty() ? 0 : all.rmse.back())) break;
    // rays alone are what an exact picture is made of
    CATENA_TRY(const Measured error, next.fast ? search.of_picture(next) : search.of_rays(next));
    all.rmse.push_back(error.rmse);
  }
  return all;
}

Result<double> rmse_of(Renderer& renderer, const FramePacket& packet, const RenderSettings& settings) {
  if (!draws_rays(packet)) return 0.0;
  CATENA_TRY(const MeasuredSettings one, measure_rmse(renderer, packet, {settings}, [](double) { return true; }));
  return one.rmse.front();
}

std::string describe(const RenderSettings& settings) {
  const char* bits = settings.texels == TexelFormat::automatic ? ""
                     : settings.texels == TexelFormat::r16f    ? ", 16 bits a voxel"
                                                               : ", 32 bits a voxel";
  if (!settings.fast) return fmt::format("exact, step {:g}{}", settings.step_voxels, bits);
  const FastSettings& f = *settings.fast;
  std::string text = fmt::format("fast, step {:g}", f.step_voxels);
  if (f.smooth_gradients) text += ", smooth gradients";
  if (f.spacing > 1) text += fmt::format(", every {} pixel", f.spacing == 2 ? "2nd" : "4th");
  if (f.spacing == 4 && f.refine_half_255 >= 0) text += fmt::format(", every 2nd above {:.2g}", f.refine_half_255);
  if (f.spacing > 1 && f.refine_full_255 >= 0) text += fmt::format(", every pixel above {:.2g}", f.refine_full_255);
  return text;
}

}  // namespace catena::render

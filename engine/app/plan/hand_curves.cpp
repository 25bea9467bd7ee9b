/// Curves of the hand: which links leave their setting open, what of a curve agrees with what a link says, and the tick without them.
#include <algorithm>
#include <cmath>

#include "engine/app/plan/cells.h"
#include "engine/app/plan/hand_plan.h"
#include "engine/app/tradeoff/measure/hand/replay_link.h"
#include "engine/app/tradeoff/measure/hand/streamline.h"

namespace catena::app::plan {
namespace {

constexpr const char *kRestId = "hand-rest", *kRest = "the tick without the links that a plan chooses for",
                     *kBare = "the tick without links";

using tradeoff::StreamlineSetting;

/// Whether the setting is what the link says, as far as it says anything.
bool agrees(const StreamlineSetting& setting, const json::Node& link) {
  const json::Node *follow = link.find("follow"), *method = link.find("method"), *tolerance = link.find("tolerance");
  if (follow != nullptr && (follow->string == "selected") != setting.selected) return false;
  if (method != nullptr && (setting.selected || flow::method_word(*setting.method) != method->string)) return false;
  return tolerance == nullptr || !setting.tolerance || std::fabs(*setting.tolerance - tolerance->number) <= 1e-9 * tolerance->number;
}

/// Where there is a choice. A link on the seed of a widget has no line before it is felt.
std::vector<StreamlineSetting> open_settings(const json::Node& link) {
  std::vector<StreamlineSetting> open = tradeoff::streamline_settings(link);
  // fixed steps have no tolerance: they err by the hand's speed and way, of which a curve knows one
  const bool asks_for_method = link.find("method") != nullptr;
  std::erase_if(open, [&](const StreamlineSetting& setting) {
    return !agrees(setting, link) || (!asks_for_method && !setting.selected && !setting.tolerance);
  });
  if (open.size() < 2) open.clear();
  return open;
}

/// The keys that the link does not have already.
LinkKeys new_keys(const StreamlineSetting& setting, const json::Node& link) {
  LinkKeys keys = setting.keys;
  std::erase_if(keys, [&](const auto& key) { return link.find(key.first) != nullptr; });
  return keys;
}

std::vector<tradeoff::LinkOf> open_links(const scene::Scene& scene) {
  std::vector<tradeoff::LinkOf> links = tradeoff::links_of_type(scene, "streamline");
  std::erase_if(links, [](const tradeoff::LinkOf& link) { return open_settings(link.node).empty(); });
  return links;
}

/// The source of the link's field where it may become cubic: a line field's axes stay linear.
scene::FieldSource* open_source(scene::Scene& scene, const json::Node& link) {
  const json::Node *name = link.find("field"), *kind = link.find("kind");
  if (name == nullptr || (kind != nullptr && kind->string == "line")) return nullptr;
  const scene::Entity field = scene::find_field(scene, name->string);
  if (!field) return nullptr;
  scene::FieldSource& source = scene.world.get<scene::FieldSource>(field);
  return leaves_cells_open(source) ? &source : nullptr;
}

std::string cubic_curve_id(const std::string& link) { return "hand-cubic-streamline-" + link; }

/// The curve of a link once more, with cubic cells: only where both floors are known are they compared.
void add_cubic(tradeoff::Subject& subject, const tradeoff::LinkOf& link, std::vector<Curve>& curves) {
  scene::FieldSource* source = open_source(subject.scene, link.node);
  if (source == nullptr || !(curves.back().floor > 0)) return;
  const scene::FieldSource linear = *source;
  if (!make_cubic(*source)) return;
  auto curve = tradeoff::measure_followed(subject, link);
  *source = linear;
  if (!curve || !(curve->floor > 0)) return;
  curve->id = cubic_curve_id(link.name);
  curve->title += ", cubic cells";
  curves.push_back(std::move(*curve));
}

}  // namespace

Result<std::vector<Curve>> measure_hand(tradeoff::Subject& subject) {
  std::vector<Curve> curves;
  std::vector<std::string> chosen;
  for (const tradeoff::LinkOf& link : open_links(subject.scene)) {
    auto curve = tradeoff::measure_followed(subject, link);
    if (!curve) {
      subject.left_out.push_back(curve.error().message);
      continue;
    }
    curves.push_back(std::move(*curve));
    add_cubic(subject, link, curves);
    chosen.push_back(link.name);
  }
  haptics::Program bare = tradeoff::without_widgets(*subject.program), rest = bare;
  std::erase_if(rest.links, [&](const haptics::Link& link) { return std::find(chosen.begin(), chosen.end(), link.name) != chosen.end(); });
  bare.links.clear();
  const std::vector<haptics::ProbeSample> path = subject.motion.samples(subject.rate_hz);
  Curve curve;
  curve.id = kRestId;
  curve.title = kRest;
  curve.time_name = "ns a tick";
  curve.points = {{kRest, "", ""}, {kBare, "", ""}};
  CATENA_CHECK(tradeoff::time_points(curve, {tradeoff::ticks_of(rest, path), tradeoff::ticks_of(bare, path)}, 0.3 * subject.effort.hand_s));
  curves.push_back(std::move(curve));
  for (Curve& one : curves) one.part = "hand";
  return curves;
}

std::optional<HandCurves> hand_curves(scene::Scene& scene, const std::vector<Curve>& curves, double rate_hz) {
  const std::vector<tradeoff::LinkOf> links = open_links(scene);
  HandCurves made;
  bool has_rest = false;
  for (const Curve& curve : curves) {
    if (curve.id == kRestId) {
      if (curve.points.size() != 2 || !std::isfinite(curve.points[0].time.median) || !std::isfinite(curve.points[1].time.median))
        return std::nullopt;
      made.rest_ns = curve.points[0].time.median;
      made.bare_ns = curve.points[1].time.median;
      has_rest = true;
      continue;
    }
    const auto id_is = [&](const std::string& id) { return id == curve.id; };
    const auto link = std::find_if(links.begin(), links.end(), [&](const auto& l) {
      return id_is(tradeoff::streamline_curve_id(l.name)) || id_is(cubic_curve_id(l.name));
    });
    if (link == links.end()) return std::nullopt;
    const bool cubic = id_is(cubic_curve_id(link->name));
    if (cubic && open_source(scene, link->node) == nullptr) return std::nullopt;
    const field::AnyField field = tradeoff::field_of(scene, link->node);
    if (!field.vector) return std::nullopt;
    CATENA_ASSERT(link->node.find("field") != nullptr);
    LinkCurve one{link->name, link->node.find("field")->string, cubic, field.vector->length(), 1e-3 * rate_hz, curve, {}};
    one.curve.points.clear();
    const std::vector<StreamlineSetting> open = open_settings(link->node);
    for (const tradeoff::Point& point : curve.points) {
      if (!point.offered) continue;
      const auto setting = std::find_if(open.begin(), open.end(), [&](const auto& s) { return s.words == point.setting; });
      if (setting == open.end()) continue;
      one.curve.points.push_back(point);
      one.keys.push_back(new_keys(*setting, link->node));
    }
    if (one.curve.points.empty()) return std::nullopt;
    made.links.push_back(std::move(one));
  }
  return has_rest ? std::optional(made) : std::nullopt;
}

}  // namespace catena::app::plan

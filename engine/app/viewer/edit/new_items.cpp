#include "engine/app/viewer/edit/new_items.h"

#include <algorithm>
#include <cmath>

#include "engine/app/viewer/edit/field_values.h"
#include "engine/app/viewer/edit/plot_frame.h"
#include "engine/app/viewer/edit/pointers.h"
#include "engine/app/viewer/edit/scene_items.h"
#include "engine/scene/color_maps.h"
#include "engine/scene/write_values.h"

namespace catena::app {

namespace {

constexpr double kBall = 0.35;  // its radius by the shortest edge of the domain
constexpr int kSeeds = 60;

struct Domain {
  Vec3 middle{0.0};
  double shortest = 0;
};

Domain domain_of(const field::Field& field) {
  const field::Box& box = field.index_box();
  Domain domain{field.mapping().world_from_index(0.5 * (box.lo + box.hi)), HUGE_VAL};
  for (int i = 0; i < 3; ++i) {
    Vec3 edge(0.0);
    edge[i] = box.hi[i] - box.lo[i];
    const double length = norm(field.mapping().world_from_index_linear * edge);
    if (length > 0) domain.shortest = std::min(domain.shortest, length);
  }
  if (!std::isfinite(domain.shortest)) domain.shortest = field.length();
  return domain;
}

double default_level(const field::ScalarField& field, const std::vector<float>& sorted) {
  double lo = field.min_value(), hi = field.max_value();
  if (!sorted.empty()) lo = quantile_of(sorted, 0.02), hi = quantile_of(sorted, 0.98);
  if (!(lo < hi)) lo = field.min_value(), hi = field.max_value();
  if (!std::isfinite(lo) || !std::isfinite(hi)) return std::isfinite(lo) ? lo + 1 : std::isfinite(hi) ? hi - 1 : 0;
  const double middle = 0.5 * lo + 0.5 * hi, level = rounded_in(middle, lo, hi, 200);
  return level >= field.min_value() && level <= field.max_value() ? level : middle;
}

/// The level at which a link of the chain lies on the field: what is seen is what is felt.
bool take_felt_level(const scene::Scene& scene, scene::Entity field, scene::Isosurface& surface) {
  const auto felt = json::parse(felt_level(scene, name_of(scene, field)), "level");
  if (!felt) return false;
  if (const json::Node* widget = felt->find("widget")) surface.level_from = scene::find_widget(scene, widget->string);
  surface.level = felt->number;
  return felt->kind == json::Kind::number || surface.level_from;
}

}  // namespace

std::string pointer_of_new(ShowAs as) {
  constexpr const char* pointers[] = {"/volumes/-", "/isosurfaces/-", "/slices/-", "/streamlines/-"};
  return pointers[static_cast<int>(as)];
}

const char* word_of(ShowAs as) {
  constexpr const char* words[] = {"volume", "isosurface", "slice", "streamlines"};
  return words[static_cast<int>(as)];
}

bool can_show(const field::AnyField& field, ShowAs as) {
  if (as == ShowAs::slice) return field.get() != nullptr;
  return as == ShowAs::streamlines ? field.vector != nullptr : field.scalar != nullptr;
}

std::string new_item(const scene::Scene& scene, scene::Entity field, const field::AnyField& values, ShowAs as,
                     const std::vector<float>& sorted) {
  const Domain domain = domain_of(*values.get());
  const auto rounded = [&](double value) { return rounded_in(value, 0, domain.shortest); };
  const Vec3 middle{rounded(domain.middle.x), rounded(domain.middle.y), rounded(domain.middle.z)};
  scene::ColorBy colors;
  colors.named.map = scene::kDefaultLineMap;
  switch (as) {
    case ShowAs::volume: {
      scene::Volume volume;
      volume.field = field;
      volume.shade = true;
      return scene::text_of(scene, volume);
    }
    case ShowAs::isosurface: {
      scene::Isosurface surface;
      surface.field = field;
      if (!take_felt_level(scene, field, surface)) surface.level = default_level(*values.scalar, sorted);
      return scene::text_of(scene, surface);
    }
    case ShowAs::slice: {
      scene::Slice slice;
      slice.shown = colors;
      slice.shown.field = field;
      slice.point = {0, 0, middle.z};
      return scene::text_of(scene, slice);
    }
    case ShowAs::streamlines:
      break;
  }
  scene::StreamlineSet set;
  set.field = field;
  set.seeds.pattern.emplace();
  set.seeds.pattern->kind = scene::SeedPattern::Kind::sphere;
  set.seeds.pattern->origin = middle;
  set.seeds.pattern->radius = rounded(kBall * domain.shortest);
  set.seeds.pattern->count = kSeeds;
  set.seeds.pattern->inside = true;
  set.color_by = colors;
  set.color_by->what = scene::ColorBy::What::speed;
  return scene::text_of(scene, set);
}

}  // namespace catena::app

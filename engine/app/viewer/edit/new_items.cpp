#include "engine/app/viewer/edit/new_items.h"

#include <algorithm>
#include <cmath>

#include "engine/app/viewer/edit/field_values.h"
#include "engine/app/viewer/edit/plot_frame.h"
#include "engine/app/viewer/edit/pointers.h"
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

std::string new_item(const std::string& name, const field::AnyField& field, ShowAs as, const std::vector<float>& sorted,
                     const std::string& felt) {
  const std::string start = "{\"field\": \"" + name + "\", ";
  const Domain domain = domain_of(*field.get());
  const auto rounded = [&](double value) { return rounded_in(value, 0, domain.shortest); };
  switch (as) {
    case ShowAs::volume:
      return start + "\"shade\": true}";
    case ShowAs::isosurface:
      return start + "\"level\": " + (felt.empty() ? scene::text_of(default_level(*field.scalar, sorted)) : felt) + ", \"opacity\": 1}";
    case ShowAs::slice:
      return start + "\"axis\": \"z\", \"at\": " + scene::text_of(rounded(domain.middle.z)) + ", \"color\": \"viridis\"}";
    case ShowAs::streamlines:
      break;
  }
  const Vec3 middle{rounded(domain.middle.x), rounded(domain.middle.y), rounded(domain.middle.z)};
  return start + "\"seeds\": {\"sphere\": {\"center\": " + scene::text_of(middle) +
         ", \"radius\": " + scene::text_of(rounded(kBall * domain.shortest)) + ", \"count\": " + std::to_string(kSeeds) +
         ", \"inside\": true}}, \"color_by\": {\"quantity\": \"speed\", \"color\": \"viridis\"}}";
}

}  // namespace catena::app

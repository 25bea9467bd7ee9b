// SPDX-License-Identifier: MIT
/// Helpers of the constraint tests: fields by name, a constraint from JSON text, a link driven tick by tick.
#pragma once
#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "engine/field/analytic/analytic.h"
#include "engine/field/grid/grid.h"
#include "haptics/constraints/registry.h"

namespace catena::haptics::tests {

using ConstraintPtr = std::shared_ptr<const Constraint>;

inline field::ScalarFieldPtr analytic_field(const std::string& name, double scale = 1) {
  auto made = field::make_analytic(name, {.scale = scale, .part = {}});
  CATENA_ASSERT(static_cast<bool>(made));
  return made->scalar;
}

inline field::ScalarFieldPtr sampled_field(const std::string& name, int resolution, double box = 2) {
  return field::sample_on_grid(*analytic_field(name), resolution, -box, box);
}

/// A grid from a function of the world position.
template <class F>
std::shared_ptr<const field::ScalarGrid> sample_scalar_grid(const field::Mapping& mapping, const field::Index3& size, const F& f,
                                                            const std::vector<std::uint8_t>& valid = {}) {
  std::vector<float> values;
  for (int z = 0; z < size.z; ++z)
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x) values.push_back(static_cast<float>(f(mapping.world_from_index(Vec3(x, y, z)))));
  return field::make_scalar_grid("made", mapping, size, values, valid);
}

struct Fields {
  std::map<std::string, field::AnyField> named;
  std::map<std::string, mesh::MeshPtr> meshes;
  std::map<std::string, curves::CurveSetPtr> curves;
  std::map<std::string, curves::PointSetPtr> points;
  double proxy_tolerance = BuildContext().proxy_tolerance;
  BuildContext context() const {
    BuildContext c;
    c.proxy_tolerance = proxy_tolerance;
    c.field = [this](const json::Node& where, const std::string& name) -> Result<field::AnyField> {
      const auto it = named.find(name);
      if (it == named.end()) return json::error_at(where, "no field " + name);
      return it->second;
    };
    c.mesh = [this](const json::Node& where, const std::string& name) -> Result<mesh::MeshPtr> {
      const auto it = meshes.find(name);
      if (it == meshes.end()) return json::error_at(where, "no mesh " + name);
      return it->second;
    };
    c.points = [this](const json::Node& where, const std::string& name) -> Result<curves::PointSetPtr> {
      const auto it = points.find(name);
      if (it == points.end()) return json::error_at(where, "no points " + name);
      return it->second;
    };
    c.curves = [this](const json::Node& where, const std::string& name) -> Result<curves::CurveSetPtr> {
      const auto it = curves.find(name);
      if (it == curves.end()) return json::error_at(where, "no curves " + name);
      return it->second;
    };
    c.curve = [](const json::Node&, const std::string&, const flow::Flow& flow, const Vec3& seed) { return flow::trace(flow, seed); };
    return c;
  }
};

inline Result<ConstraintPtr> try_build(const std::string& text, const Fields& fields = {}) {
  auto node = json::parse(text, "scene.json");
  if (!node) return node.error();
  return build_constraint(*node, fields.context());
}

inline ConstraintPtr build(const std::string& text, const Fields& fields = {}) {
  auto made = try_build(text, fields);
  if (!made) {
    ADD_FAILURE() << made.error().message << "\n" << text;
    return nullptr;
  }
  return *made;
}

inline ConstraintPtr isosurface(field::ScalarFieldPtr f, double level, const std::string& more = "") {
  Fields fields;
  fields.named["f"].scalar = std::move(f);
  char number[40];
  std::snprintf(number, sizeof number, "%.17g", level);
  return build(std::string(R"({"name": "a", "type": "isosurface", "field": "f", "level": )") + number + more + "}", fields);
}

/// Error of a proxy relative to the closest point on a level, by the field's own samples.
struct SurfaceCheck {
  double off_level, tangential;  ///< distance from the level and tangential residual, as fractions of L
};

inline SurfaceCheck check_on_surface(const field::ScalarField& f, double level, const Vec3& probe, const Vec3& proxy) {
  field::Cursor cursor;
  const auto s = f.sample(proxy, cursor);
  const Vec3 n = direction(s.gradient), e = probe - proxy;
  return {std::fabs(s.value - level) / norm(s.gradient) / f.domain_length(), norm(e - n * dot(n, e)) / f.domain_length()};
}

/// One link, driven as in the tick.
struct Rig {
  explicit Rig(ConstraintPtr c) : constraint(std::move(c)) {}
  const LinkState& tick(const Vec3& probe) {
    state.begin_tick();
    if (!state.started) {
      state.switched_on = state.started = true;
      constraint->start(probe, state, scratch);
    }
    constraint->advance(probe, state, scratch);
    return state;
  }
  ConstraintPtr constraint;
  LinkState state;
  LinkScratch scratch;
};

struct Random {
  std::mt19937_64 engine;
  explicit Random(std::uint64_t seed) : engine(seed) {}
  double uniform(double lo, double hi) { return lo + (hi - lo) * (static_cast<double>(engine() >> 11) * 0x1p-53); }
  Vec3 box(double half) { return {uniform(-half, half), uniform(-half, half), uniform(-half, half)}; }
  Vec3 unit() {
    while (true) {
      const Vec3 v = box(1);
      if (dot(v, v) < 1 && dot(v, v) > 1e-4) return direction(v);
    }
  }
};

/// Quantiles of a sample.
struct Quantiles {
  std::vector<int> values;
  void add(int v) { values.push_back(v); }
  int at_quantile(double part) {
    std::sort(values.begin(), values.end());
    return values.empty() ? 0 : values[static_cast<std::size_t>(part * static_cast<double>(values.size() - 1))];
  }
};

}  // namespace catena::haptics::tests

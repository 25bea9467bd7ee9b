// SPDX-License-Identifier: MIT
/// Builds streamline links from scene text, over named fields, and drives them tick by tick.
#pragma once
#include <gtest/gtest.h>

#include <map>

#include "haptics/constraints/streamline/streamline.h"
#include "tests/engine/geometry/flow/lambda_field.h"

namespace catena::test {

struct StreamlineFixture {
  std::map<std::string, field::AnyField> fields;
  haptics::BuildContext context;
  mutable flow::CurvePtr last_curve;

  StreamlineFixture() {
    context.field = [this](const json::Node& where, const std::string& name) -> Result<field::AnyField> {
      const auto found = fields.find(name);
      if (found == fields.end()) return json::error_at(where, "unknown field \"" + name + "\"");
      return found->second;
    };
    context.curve = [this](const json::Node& where, const std::string&, const flow::Flow& flow,
                           const Vec3& seed) -> Result<flow::CurvePtr> {
      auto curve = flow::trace(flow, seed);
      if (!curve) return json::error_at(where, curve.error().message);
      last_curve = *curve;
      return *curve;
    };
  }
  StreamlineFixture& with(const std::string& name, field::VectorFieldPtr field) {
    fields[name].vector = std::move(field);
    return *this;
  }
  Result<std::shared_ptr<const haptics::Constraint>> build(const std::string& text) const {
    CATENA_TRY(const json::Node node, json::parse(text, "scene.json"));
    return haptics::streamline_constraint().build(node, context);
  }
  std::shared_ptr<const haptics::Constraint> link(const std::string& text) const {
    auto built = build(text);
    EXPECT_TRUE(built) << (built ? "" : built.error().message);
    return built ? *built : nullptr;
  }
};

/// One link, driven as in the tick.
struct LinkDriver {
  std::shared_ptr<const haptics::Constraint> constraint;
  haptics::LinkState state;
  haptics::LinkScratch scratch;
  bool started = false;

  explicit LinkDriver(std::shared_ptr<const haptics::Constraint> c) : constraint(std::move(c)) {}
  const Vec3& to(const Vec3& probe) {
    state.begin_tick();
    if (!started) constraint->start(probe, state, scratch);
    started = true;
    constraint->advance(probe, state, scratch);
    return state.proxy;
  }
};

}  // namespace catena::test

// SPDX-License-Identifier: MIT
// The chain in a loop of one's own, 1000 times a second: no thread, scene or file of Catena. A link is built from the same words that a
// scene has; here its streamline and its isosurface are of two formulas, and a probe that winds along the flow goes into the ball.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <thread>

#include "engine/base/json.h"
#include "engine/field/analytic/analytic.h"
#include "engine/geometry/flow/curve.h"
#include "haptics/build/build_program.h"
#include "haptics/chain/tick.h"

using namespace catena;
using namespace catena::haptics;

Result<std::shared_ptr<const HapticProgram>> make_program() {
  std::map<std::string, field::AnyField> fields;
  CATENA_TRY(fields["flow"], field::make_analytic("helix"));
  CATENA_TRY(fields["ball"], field::make_analytic("sphere"));

  // What a link may ask for while it is built.
  BuildContext context;
  context.field = [&](const json::Node& where, const std::string& name) -> Result<field::AnyField> {
    if (const auto found = fields.find(name); found != fields.end()) return found->second;
    return json::error_at(where, "there is no field \"" + name + "\"");
  };
  context.curve = [](const json::Node&, const std::string&, const flow::Flow& flow, const Vec3& seed) { return flow::trace(flow, seed); };

  auto program = std::make_shared<HapticProgram>();
  program->meters_per_unit = 0.05;
  for (const char* words : {R"({"name": "line", "type": "streamline", "field": "flow", "seed": [0.6, 0, -1.2]})",
                            R"({"name": "skin", "type": "isosurface", "field": "ball", "level": 1, "free": "above", "release": 0.3})"}) {
    CATENA_TRY(const json::Node node, json::parse(words, "own_loop"));
    CATENA_TRY(Link link, build_link(node, program->coupling, context));
    program->links.push_back(std::move(link));
  }
  return std::shared_ptr<const HapticProgram>(program);
}

int main() {
  const auto program = make_program();
  if (!program) return std::fprintf(stderr, "%s\n", program.error().message.c_str()), 2;

  // What a tick changes: plain memory, allocated before the loop.
  const auto state = std::make_unique<ChainState>();
  const auto scratch = std::make_unique<ChainScratch>();
  HapticState out;
  auto next = std::chrono::steady_clock::now();
  for (int i = 0; i < 500; ++i) {
    const double t_s = i * 1e-3;
    const Vec3 probe(0.7 * std::cos(5 * t_s), 0.7 * std::sin(5 * t_s), -1.2 + 1.25 * t_s);
    tick(**program, {t_s, probe}, *state, *scratch, out);
    next += std::chrono::milliseconds(1);
    std::this_thread::sleep_until(next);
  }
  for (int i = 0; i < out.link_count; ++i)
    std::printf("%s: %s, proxy %.4f %.4f %.4f\n", (*program)->links[i].name.c_str(), to_string(out.links[i].status), out.links[i].proxy.x,
                out.links[i].proxy.y, out.links[i].proxy.z);
  std::printf("force %.4f %.4f %.4f N\n", out.force_n.x, out.force_n.y, out.force_n.z);
  return 0;
}

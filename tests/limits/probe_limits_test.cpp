// SPDX-License-Identifier: MIT
// Rows of the probe: extreme motions and extreme world scales.
#include <cstring>

#include "tests/acceptance/chain_fixture.h"
#include "tests/haptics/constraints/examples.h"
#include "tests/limits/limits_table.h"
#include "tests/limits/probe_path.h"

namespace catena::extremes {
namespace probe_limits_test {

using acceptance::ChainRig;
using acceptance::HapticProgram;
using acceptance::make_program;
using catena::LinkStatus;
using haptics::bitwise_equal;
using haptics::tests::Random;

const double kInf = std::numeric_limits<double>::infinity(), kNan = std::numeric_limits<double>::quiet_NaN();

/// A circular streamline, a two-sided ball and a floor, as closed forms and formulas.
constexpr const char* kChain = R"({"fields": {"v": {"analytic": "circle"}, "s": {"analytic": "sphere"}},
  "chain": [{"name": "line", "type": "streamline", "field": "v", "seed": [0.8, 0, 0]},
            {"name": "ball", "type": "isosurface", "field": "s", "level": 0.7},
            {"name": "floor", "type": "plane", "point": [0, 0, -0.3], "normal": [0, 0, 1], "free": "above"}],
  "coupling": {"stiffness": 500, "max_force": 8, "damping": 1, "ramp_s": 0.02}, "workspace": {"metres_per_unit": 0.05}})";

std::string bad_probes_between_good_ones() {
  const auto program = make_program(kChain);
  ChainRig plain(program), broken(program);
  long long ticks = 0, right = 0;
  double off = 0;
  const Vec3 bad[] = {{kNan, 0, 0}, {kInf, -kInf, 0.1}, {0.5, 0.5, -kInf}, Vec3(kNan)};
  for (int i = 0; i < 1000; ++i) {
    const double t = 2e-3 * i;
    plain.step_at(t, probe_at(i));
    broken.step_at(t, probe_at(i));
    for (std::size_t k = 0; k < 3; ++k) off = std::max(off, norm(plain.proxy(k) - broken.proxy(k)) / 4);
    const auto before = broken.state;
    const auto& out = broken.step_at(t + 1e-3, bad[i % 4]);
    bool ok = max_abs(out.force_n) == 0;
    for (std::size_t k = 0; k < 3; ++k)
      ok = ok && broken.status(k) == LinkStatus::bad_probe && out.links[k].sample_status == SampleStatus::not_finite &&
           bitwise_equal(before.links[k].proxy, broken.proxy(k));
    right += ok;
    ++ticks;
  }
  return Findings()
      .all("BAD_PROBE, NOT_FINITE, no force, proxies unchanged", right, ticks)
      .at_most("distance of the proxies in finite ticks from those of a path without bad ticks", off, 0, "L");
}

std::string thrown_to_the_end_of_numbers_and_back() {
  const auto program = make_program(kChain);
  ChainRig still(program), thrown(program);
  const Vec3 home(0.75, 0.2, 0.15);
  for (int i = 0; i < 20; ++i) still.step_to(home), thrown.step_to(home);
  double off = 0, force = 0;
  for (const double far : {1e3, 1e9, 1e30, 1e150, 1e300, 1.7e308})
    for (const Vec3& way : {Vec3(1, 0, 0), Vec3(-1, 1, 0.3), Vec3(0, 0, -1)}) {
      for (int i = 0; i < 3; ++i) force = std::max(force, norm(thrown.step_to(far * way).force_n));
      for (int i = 0; i < 60; ++i) force = std::max(force, norm(thrown.step_to(home).force_n));
      for (std::size_t k = 0; k < 3; ++k) off = std::max(off, norm(still.proxy(k) - thrown.proxy(k)) / 4);
    }
  return Findings()
      .at_most("force above 8 N by", force - 8, 1e-11, "N")
      .at_most("distance of the proxies from their positions 60 ms after the return", off, 1e-9, "L");
}

std::string ten_metres_a_second() {
  // 0.2 units per tick on a circle about the same axis, so that the closest points are known in every tick
  ChainRig chain(make_program(R"({"fields": {"v": {"analytic": "circle"}},
    "chain": [{"name": "line", "type": "streamline", "field": "v", "seed": [0.8, 0, 0]},
              {"name": "floor", "type": "plane", "point": [0, 0, -0.3], "normal": [0, 0, 1]}],
    "coupling": {"stiffness": 500, "max_force": 8}, "workspace": {"metres_per_unit": 0.05}})"));
  double off = 0, force = 0;
  long long ok = 0;
  constexpr int kTicks = 3000;
  for (int i = 0; i < kTicks; ++i) {
    const double a = 0.2 * i;
    const Vec3 out(std::cos(a), std::sin(a), 0);
    force = std::max(force, norm(chain.step_to(out + Vec3(0, 0, 0.3 * std::sin(3 * a))).force_n));
    off = std::max({off, norm(chain.proxy(0) - 0.8 * out) / 4, norm(chain.proxy(1) - (0.8 * out - Vec3(0, 0, 0.3))) / 4});
    ok += chain.status(0) == LinkStatus::ok && chain.status(1) == LinkStatus::ok;
  }
  return Findings()
      .all("OK", ok, kTicks)
      .at_most("distance of the proxies from the closed form", off, 1e-9, "L")
      .at_most("force above 8 N by", force - 8, 1e-11, "N");
}

// ---- a resting probe ----

/// The state without its clocks; with equal time steps it depends on the probe only.
std::string without_clocks(haptics::ChainState state) {
  state.last_probe_t_s = state.last_tick_t_s = 0;
  state.ticks = 0;
  std::string bytes(sizeof state, '\0');
  std::memcpy(bytes.data(), static_cast<const void*>(&state), sizeof state);
  return bytes;
}

#ifdef CATENA_SANITIZED
constexpr std::uint64_t kHour = 721'000;
#else
constexpr std::uint64_t kHour = 3'600'000;  // ticks
#endif

constexpr double kStep = 0x1p-10;  // seconds; a power of two, so that sums are exact and all steps are equal

/// Number of ticks under a still probe until the state equals, bit for bit, that of one round of the ledger's ring before, with equal
/// reports in between; or `max_ticks`. From then on nothing changes, because the next state depends on state, probe and step only.
int ticks_to_rest(ChainRig& rig, const Vec3& probe, int max_ticks) {
  constexpr int kRound = haptics::PassivityState::kHistoryLength;
  std::array<std::string, kRound> before;
  Vec3 force(kInf);
  for (int i = 0, same = 0; i < max_ticks; ++i) {
    rig.step_at(kStep * static_cast<double>(rig.state.ticks), probe);
    std::string now = without_clocks(rig.state);
    std::string& last = before[static_cast<std::size_t>(i % kRound)];
    same = bitwise_equal(force, rig.out.force_n) ? same + 1 : 0;
    force = rig.out.force_n;
    if (now == last && same >= kRound) return i;
    last = std::move(now);
  }
  return max_ticks;
}

std::string still_for_an_hour() {
  ChainRig rig(make_program(kChain));
  const Vec3 probe = probe_at(400);
  for (int i = 0; i < 400; ++i) rig.step_at(kStep * i, probe_at(i));
  const int rest = ticks_to_rest(rig, probe, 1000);
  const std::string there = without_clocks(rig.state);
  long long same = 0, ticks = 0;
  double force = 0;
  while (rig.state.ticks < kHour) {
    force = norm(rig.step_at(kStep * static_cast<double>(rig.state.ticks), probe).force_n);
    if (++ticks % 360'000 == 0) same += without_clocks(rig.state) == there;
  }
  return Findings()
      .at_most("ticks until the state repeats", rest, 100)
      .all("identical bits every 360000 ticks,", same, ticks / 360'000)
      .add(force > 1 ? "the force is still there" : "the force is gone");
}

std::string every_link_comes_to_rest() {
  long long rested = 0, asked = 0, soon = 0, quick = 0;
  std::string which;
  for (const haptics::tests::Example& example : haptics::tests::all_examples()) {
    if (example.body.find("\"linear\"") != std::string::npos)
      continue;  // Eqs. 1-2 as printed (method "linear") never rest; they are the baseline
    const auto constraint =
        haptics::tests::build(R"({"name": "a", "type": ")" + example.type + "\", " + example.body + "}", haptics::tests::fields());
    if (!constraint) return "cannot be built: " + example.body.substr(0, 80);
    const bool slow = example.type == "viscosity";  // time constants up to 1 s, with 37 of them until the last bit
    const int max_ticks = slow ? 61'000 : 1024;
    ChainRig rig(make_program(std::vector{constraint}));
    Random random(7);
    for (int place = 0; place < 8; ++place) {
      const Vec3 probe = random.box(place < 6 ? 1.2 : 5);
      const bool rests = ticks_to_rest(rig, probe, max_ticks) < max_ticks;
      ++(slow ? asked : quick);
      (slow ? rested : soon) += rests;
      if (!rests) which += ", not " + example.type + " {" + example.body.substr(0, 80) + "} at probe " + std::to_string(place);
    }
  }
  return Findings().all("the state repeats within 1 s", soon, quick).all("with viscosity within a minute", rested, asked).text() + which;
}

}  // namespace probe_limits_test

Group probe_rows() {
  using namespace probe_limits_test;
  return {
      "Probe and proxies",
      {
          {"BadProbesBetweenGoodOnes", "Probe NaN or infinite in every second tick; a streamline, an isosurface and a plane",
           "BAD_PROBE, NOT_FINITE, no force, proxies unchanged in every case; distance of the proxies in finite ticks from those of a "
           "path without bad ticks at most 0 L",
           bad_probes_between_good_ones},
          proved_elsewhere("Random NaN, infinity, 1e300 and denormal values, for every type of link and chain, 1e7 ticks",
                           "all output is finite, no force exceeds its limit, no allocation", "Endurance.HostileTicksKeepTheStateValid"),
          {"ThrownToTheEndOfNumbersAndBack", "Probe jumps 1e3 to 1.7e308 units away for 3 ticks, and back",
           "force above 8 N by at most 1e-11 N; distance of the proxies from their positions 60 ms after the return at most 1e-09 L",
           thrown_to_the_end_of_numbers_and_back},
          proved_elsewhere("Probe jumps across the domain in every tick, for every type of link",
                           "at most 257 fetches and 4096 units of work in every tick", "Conformance.WorkIsBoundedUnderTeleports"),
          {"TenMetresASecond", "Probe circles a streamline and crosses a plane at 10 m/s (0.2 units a tick)",
           "OK in every case; distance of the proxies from the closed form at most 1e-09 L; force above 8 N by at most 1e-11 N",
           ten_metres_a_second},
          proved_elsewhere("Probe crosses a thin sheet within one tick", "the proxy stays on the near side",
                           "IsosurfaceSemantics.AFastHandDoesNotTunnelThroughAThinSheet"),
          proved_elsewhere("The same with triangles", "the proxy stays on the near side", "Mesh.FastHandsDoNotTunnel"),
          {"StillForAnHour", "Probe at rest for 3.6e6 ticks; a streamline, an isosurface and a plane",
           "ticks until the state repeats at most 100; identical bits every 360000 ticks, in every case; the force is still there",
           still_for_an_hour},
          {"EveryLinkComesToRest",
           "Probe at rest at 8 positions, for every type of link. The next state depends only on state, probe and time step: a state "
           "that repeats once never changes again",
           "the state repeats within 1 s in every case; with viscosity within a minute in every case", every_link_comes_to_rest},
      }};
}

}  // namespace catena::extremes

// SPDX-License-Identifier: MIT
/// catena.Chain: the haptic force along positions of the probe, tick by tick, exactly as `catena replay` computes it.
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <memory>
#include <mutex>
#include <span>

#include "engine/python/module.h"
#include "haptics/build/build_program.h"
#include "haptics/chain/offline_ticks.h"
#include "haptics/device/registry.h"
#include "haptics/servo/device_limits.h"

namespace catena::python {
namespace {

/// Limits of the device that the scene names, as in `replay`; without a device there are no limits.
haptics::DeviceLimits limits_of(const scene::Scene& scene) {
  if (!scene.device) return {};
  const haptics::DeviceSettings settings = unwrap(haptics::read_device_settings(*scene.device, scene.path));
  return haptics::compute_device_limits(haptics::nominal_capabilities(settings.type), settings);
}

/// Results of N ticks as arrays.
struct Ticks {
  py::array_t<double> t, proxies, forces, link_forces, gaps;
  py::array_t<std::uint8_t> statuses;

  Ticks(py::ssize_t n, py::ssize_t links)
      : t(n),
        proxies({n, links, py::ssize_t(3)}),
        forces({n, py::ssize_t(3)}),
        link_forces({n, links, py::ssize_t(3)}),
        gaps({n, links}),
        statuses({n, links}) {}
};

/// Output pointers for the next tick.
struct Rows {
  double *t, *proxies, *forces, *link_forces, *gaps;
  std::uint8_t* statuses;
  explicit Rows(Ticks& ticks)
      : t(ticks.t.mutable_data()),
        proxies(ticks.proxies.mutable_data()),
        forces(ticks.forces.mutable_data()),
        link_forces(ticks.link_forces.mutable_data()),
        gaps(ticks.gaps.mutable_data()),
        statuses(ticks.statuses.mutable_data()) {}

  static void put(double*& to, const Vec3& v) { *to++ = v.x, *to++ = v.y, *to++ = v.z; }
  void add(const HapticState& state) {
    *t++ = state.t_s;
    put(forces, state.force_n);
    for (int i = 0; i < state.link_count; ++i) {
      const LinkReport& link = state.links[static_cast<std::size_t>(i)];
      put(proxies, link.proxy);
      put(link_forces, link.force_n);
      *gaps++ = link.gap;
      *statuses++ = static_cast<std::uint8_t>(link.status);
    }
  }
};

class Chain {
 public:
  Chain(const py::object& scene, const py::object& fields, double rate_hz) : rate_hz_(rate_hz) {
    if (!(rate_hz > 0) || !std::isfinite(rate_hz)) throw Failure(Error{"rate_hz is not positive; ticks a second were expected"});
    scene::Scene read = to_scene(scene, fields);
    const py::gil_scoped_release unlocked;
    program_ = unwrap(haptics::build_program(read, limits_of(read)));
    reset();
  }

  /// Resets the state; waits until a run on another thread has finished.
  void reset() {
    const std::lock_guard turn(turn_);
    state_ = std::make_unique<haptics::ChainState>();
    scratch_ = std::make_unique<haptics::ChainScratch>();
    hash_ = {};
    ticks_ = since_ = 0;
    from_s_ = 0;
  }

  Ticks run(const Points& positions, const py::object& times, const py::object& buttons) {
    const NumberArray places = to_rows(positions, "positions");  // read in place
    const auto count = static_cast<std::size_t>(places.size() / 3);
    // without times the ticks are evenly spaced; without buttons none is pressed
    const NumberArray column_t = times.is_none() ? NumberArray() : column(times, count, "t");
    const std::span<const double> t(column_t.data(), times.is_none() ? 0 : count);
    const std::vector<std::uint32_t> pressed =
        buttons.is_none() ? std::vector<std::uint32_t>() : buttons_of(column(buttons, count, "buttons"));
    Ticks out(static_cast<py::ssize_t>(count), static_cast<py::ssize_t>(program_->links.size()));
    Rows rows(out);
    const py::gil_scoped_release unlocked;
    const std::lock_guard turn(turn_);
    check_times(t);
    const double* place = places.data();
    for (std::size_t i = 0; i < count; ++i, place += 3) {
      haptics::ProbeSample probe;
      probe.t_s = t.empty() ? next_t_s() : t[i];
      if (!t.empty()) from_s_ = t[i], since_ = 0;
      ++since_;
      probe.position = {place[0], place[1], place[2]};
      if (!pressed.empty()) probe.buttons = pressed[i];
      runner_.run(*program_, probe, *state_, *scratch_, last_);
      hash_.add(last_);
      ++ticks_;
      rows.add(last_);
    }
    return out;
  }

  std::vector<std::string> links() const {
    std::vector<std::string> names;
    for (const haptics::Link& link : program_->links) names.push_back(link.name);
    return names;
  }
  double metres_per_unit() const { return program_->meters_per_unit; }
  std::uint64_t ticks() const {
    const std::lock_guard turn(turn_);
    return ticks_;
  }
  std::uint64_t state_hash() const {
    const std::lock_guard turn(turn_);
    return hash_.value();
  }

 private:
  double next_t_s() const { return from_s_ + static_cast<double>(since_) / rate_hz_; }

  /// Throws unless the times are finite and rising, also across calls, as `replay` requires.
  void check_times(std::span<const double> t) const {
    double last = ticks_ == 0 ? -std::numeric_limits<double>::infinity() : last_.t_s;
    for (const double s : t) {
      if (!std::isfinite(s)) throw Failure(Error{fmt::format("t: holds {}; finite seconds were expected", s)});
      if (s <= last)
        throw Failure(Error{fmt::format("t: {:.9g} s after {:.9g} s; rising seconds were expected (reset() begins again)", s, last)});
      last = s;
    }
  }

  static NumberArray column(const py::object& from, std::size_t rows, const std::string& what) {
    NumberArray array = to_numbers(from, what);
    if (array.size() != static_cast<py::ssize_t>(rows))
      throw Failure(Error{what + " does not have one number for each position; " + std::to_string(rows) + " were expected"});
    return array;
  }
  static std::vector<std::uint32_t> buttons_of(const NumberArray& numbers) {
    std::vector<std::uint32_t> all;
    for (const double number : std::span(numbers.data(), static_cast<std::size_t>(numbers.size()))) {
      if (!(number >= 0 && number <= 4294967295.0) || number != std::floor(number))
        throw Failure(Error{"buttons: holds " + std::to_string(number) + "; whole numbers of 32 bits were expected"});
      all.push_back(static_cast<std::uint32_t>(number));
    }
    return all;
  }

  mutable std::mutex turn_;  ///< serializes the threads that run ticks
  double rate_hz_;
  std::shared_ptr<const haptics::HapticProgram> program_;
  std::unique_ptr<haptics::ChainState> state_;
  std::unique_ptr<haptics::ChainScratch> scratch_;
  haptics::OfflineTicks runner_;
  haptics::StateHash hash_;
  HapticState last_;
  std::uint64_t ticks_ = 0, since_ = 0;  ///< since_: ticks since from_s_, where no times are given
  double from_s_ = 0;
};

}  // namespace

void add_chain(py::module_& m) {
  py::class_<Ticks>(m, "Ticks", "What N ticks of a chain of L links said.")
      .def_readonly("t", &Ticks::t, "(N,): seconds.")
      .def_readonly("proxies", &Ticks::proxies, "(N, L, 3): every link's proxy, world units; the last one is where the hand is held.")
      .def_readonly("forces", &Ticks::forces, "(N, 3): the force on the hand, newtons, world axes.")
      .def_readonly("link_forces", &Ticks::link_forces, "(N, L, 3): every link's share before the limit, newtons.")
      .def_readonly("gaps", &Ticks::gaps, "(N, L): the distance of a link's proxy from its probe, world units.")
      .def_readonly("statuses", &Ticks::statuses, "(N, L) of uint8: indices into catena.STATUSES.");
  py::class_<Chain>(m, "Chain",
                    "The chain of proxies of a scene, felt by a probe that the caller moves. It remembers from tick to tick: run() goes on "
                    "where it was. Threads that share one wait for each other.")
      .def(py::init<const py::object&, const py::object&, double>(), py::arg("scene"), py::arg("fields") = py::none(),
           py::arg("rate_hz") = 1000.0,
           "scene: a path, or a dict as a scene file has it. fields: names and the Fields, arrays (z, y, x) or paths that stand "
           "for them.\nrate_hz: "
           "ticks a second, where run() is given no times. A scene with a \"device\" is felt within its limits.")
      .def("run", &Chain::run, py::arg("positions"), py::arg("t") = py::none(), py::arg("buttons") = py::none(),
           "A tick for each position.\n\npositions: (N, 3) or (3,), world units. t: (N,), seconds, rising; None: evenly at rate_hz, from "
           "the tick before. "
           "buttons: (N,), whole numbers, bit 0 is button 1.\nReturns Ticks. The same positions give the same bits as `catena replay`.")
      .def(
          "step",
          [](Chain& chain, const Points& position) {
            to_vec3(position, "position");
            return chain.run(position, py::none(), py::none());
          },
          py::arg("position"), "One tick: run() of one position.\n\nposition: (3,), world units. Returns Ticks with N = 1.")
      .def("reset", &Chain::reset, py::call_guard<py::gil_scoped_release>(), "Forgets all ticks: the next one is the first.")
      .def_property_readonly("links", &Chain::links, "The names of the L links, in order.")
      .def_property_readonly("metres_per_unit", &Chain::metres_per_unit, "Metres of the hand a world unit.")
      .def_property_readonly("ticks", &Chain::ticks, "How many ticks there were since the start.")
      .def_property_readonly(
          "state_hash", &Chain::state_hash,
          "A number of all that the ticks said, to the bit: `catena replay --stats` has it too, as f\"{state_hash:016x}\".");
  py::list words;
  for (int i = 0; i <= static_cast<int>(LinkStatus::bad_probe); ++i) words.append(to_string(static_cast<LinkStatus>(i)));
  m.attr("STATUSES") = py::tuple(words);
}

}  // namespace catena::python

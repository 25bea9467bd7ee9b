#include "engine/app/felt.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/base/text.h"
#include "engine/base/vec.h"

namespace catena::app {

namespace {

/// CRITICAL, PARALLEL: every place of the field would hold it.
bool is_nowhere(const exchange::LinkReport& link) { return link.status == exchange::Status::critical && link.reason == Reason::parallel; }

bool holds(const exchange::LinkReport& link) {
  using exchange::Status;
  const Status status = link.status;
  return !is_nowhere(link) && status != Status::free && status != Status::released && status != Status::no_surface &&
         status != Status::bad_probe;
}

/// "12.5 mm", or "3 m" from one metre on.
std::string hand_length(double metres) { return metres < 1 ? fmt::format("{:.3g} mm", 1e3 * metres) : fmt::format("{:.3g} m", metres); }

/// "3.88", or "1.7e+308" where that would be hundreds of digits.
std::string seconds(double s) { return s < 1e9 ? fmt::format("{:.2f}", s) : fmt::format("{:.3g}", s); }

}  // namespace

void Felt::add(const exchange::HapticState& state) {
  const double step_s = begun_ ? state.t_s - last_s_ : 0;
  if (!begun_) first_s_ = state.t_s;
  begun_ = true;
  last_s_ = state.t_s;
  const double force_n = norm(state.force_n);
  max_force_n_ = std::max(max_force_n_, force_n);
  summed_force_n_ += force_n;
  for (std::size_t i = 0; i < static_cast<std::size_t>(state.link_count); ++i) {
    const exchange::LinkReport& link = state.links[i];
    Touch& touch = touches_[i];
    ++touch.statuses[exchange::status_word(link.status)];
    touch.max_gap = std::max(touch.max_gap, link.gap);
    touch.max_force_n = std::max(touch.max_force_n, norm(link.force_n));
    const bool now = holds(link);
    touch.nowhere = touch.nowhere || is_nowhere(link);
    if (now) touch.held_s += step_s;
    if (now && !touch.holding) ++touch.holds;
    if (touch.holding && link.status == exchange::Status::released) ++touch.let_go;
    touch.holding = now;
  }
}

std::string Felt::sentence(const Touch& touch, const haptics::Link& link, const haptics::Program& program) const {
  if (touch.holds == 0) return touch.nowhere ? "not touched: CRITICAL, every place of the field would hold it (PARALLEL)" : "not touched";
  const std::string length = hand_length(program.metres_per_unit * touch.max_gap);
  const double share_n = std::min({touch.max_force_n, program.coupling.max_force_n, program.limits.max_force_n});
  const std::string lies_on = printable(link.lies_on);
  std::string text = link.one_sided ? fmt::format("pressed {} {}", length, lies_on.empty() ? "deep" : "into " + lies_on)
                                    : fmt::format("pulled up to {} off{}", length, lies_on.empty() ? "" : " " + lies_on);
  text += fmt::format("{}; held {} of {} s",
                      program.links.size() == 1 && max_force_n_ > 0 ? fmt::format(", at most {:.2g} N", max_force_n_)
                                                                    : fmt::format(", own share at most {:.2g} N", share_n),
                      seconds(touch.held_s), seconds(last_s_ - first_s_));
  if (touch.let_go == 1) text += ", let go once";
  if (touch.let_go > 1) text += fmt::format(", let go {} times", touch.let_go);
  return text;
}

std::string Felt::sentences(const haptics::Program& program) const {
  std::string text = program.links.empty() ? "the chain is empty: there is nothing to feel\n" : "";
  for (std::size_t i = 0; i < program.links.size(); ++i)
    text += printable(program.links[i].name) + ": " + sentence(touches_[i], program.links[i], program) + "\n";
  return text;
}

std::string Felt::text(const haptics::Program& program, const haptics::ReplayStats& stats) const {
  std::string text = fmt::format("{} ticks, {:.3f} us each (p99 {:.3f} us), force up to {:.3g} N, {:.3g} N on average\n", stats.ticks,
                                 1e-3 * stats.tick_ns_p50, 1e-3 * stats.tick_ns_p99, max_force_n_,
                                 stats.ticks > 0 ? summed_force_n_ / static_cast<double>(stats.ticks) : 0.0);
  if (program.links.empty()) text += "  the chain is empty: there is nothing to feel\n";
  for (std::size_t i = 0; i < program.links.size(); ++i) {
    const Touch& touch = touches_[i];
    text += fmt::format("  {}: {}. Gap {:.4g} units; ticks", printable(program.links[i].name), sentence(touch, program.links[i], program),
                        touch.max_gap);
    for (const auto& [word, count] : touch.statuses) text += fmt::format(" {} {}", word, count);
    text += '\n';
  }
  return text;
}

}  // namespace catena::app

// SPDX-License-Identifier: MIT
#include "engine/app/haptics/contact_summary.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/base/text.h"
#include "engine/base/vec.h"

namespace catena::app {

namespace {

/// Returns true for the status CRITICAL with PARALLEL: the constraint is degenerate, and every point of the field would satisfy it.
bool is_nowhere(const LinkReport& link) { return link.status == LinkStatus::critical && link.sample_status == SampleStatus::parallel; }

bool holds(const LinkReport& link) {
  const LinkStatus status = link.status;
  return !is_nowhere(link) && status != LinkStatus::free && status != LinkStatus::released && status != LinkStatus::no_surface &&
         status != LinkStatus::bad_probe;
}

/// Formats a length as "12.5 mm", or "3 m" from one meter on.
std::string hand_length(double metres) { return metres < 1 ? fmt::format("{:.3g} mm", 1e3 * metres) : fmt::format("{:.3g} m", metres); }

/// Formats a time as "3.88", or as "1.7e+308" if it is very large.
std::string seconds(double s) { return s < 1e9 ? fmt::format("{:.2f}", s) : fmt::format("{:.3g}", s); }

}  // namespace

void ContactSummary::add(const HapticState& state) {
  const double step_s = has_ticks_ ? state.t_s - last_s_ : 0;
  if (!has_ticks_) first_s_ = state.t_s;
  has_ticks_ = true;
  last_s_ = state.t_s;
  const double force_n = norm(state.force_n);
  max_force_n_ = std::max(max_force_n_, force_n);
  force_sum_n_ += force_n;
  for (std::size_t i = 0; i < static_cast<std::size_t>(state.link_count); ++i) {
    const LinkReport& link = state.links[i];
    LinkContact& touch = contacts_[i];
    ++touch.statuses[to_string(link.status)];
    touch.max_gap = std::max(touch.max_gap, link.gap);
    touch.max_force_n = std::max(touch.max_force_n, norm(link.force_n));
    const bool now = holds(link);
    touch.held_everywhere = touch.held_everywhere || is_nowhere(link);
    if (now) touch.held_s += step_s;
    if (now && !touch.is_holding) ++touch.hold_count;
    if (touch.is_holding && link.status == LinkStatus::released) ++touch.release_count;
    touch.is_holding = now;
  }
}

std::string ContactSummary::describe_link(const LinkContact& touch, const haptics::Link& link,
                                          const haptics::HapticProgram& program) const {
  if (touch.hold_count == 0)
    return touch.held_everywhere ? "not touched: CRITICAL, every point of the field satisfies the constraint (PARALLEL)" : "not touched";
  const std::string length = hand_length(program.meters_per_unit * touch.max_gap);
  const double share_n = std::min({touch.max_force_n, program.coupling.max_force_n, program.limits.max_force_n});
  const std::string lies_on = sanitize_for_terminal(link.feature_name);
  std::string text = link.one_sided ? fmt::format("pressed {} {}", length, lies_on.empty() ? "deep" : "into " + lies_on)
                                    : fmt::format("pulled up to {} away{}", length, lies_on.empty() ? "" : " from " + lies_on);
  text += fmt::format("{}; held {} of {} s",
                      program.links.size() == 1 && max_force_n_ > 0 ? fmt::format(", at most {:.2g} N", max_force_n_)
                                                                    : fmt::format(", own force at most {:.2g} N", share_n),
                      seconds(touch.held_s), seconds(last_s_ - first_s_));
  if (touch.release_count == 1) text += ", released once";
  if (touch.release_count > 1) text += fmt::format(", released {} times", touch.release_count);
  return text;
}

std::string ContactSummary::link_lines(const haptics::HapticProgram& program) const {
  std::string text = program.links.empty() ? "the chain is empty: there are no forces\n" : "";
  for (std::size_t i = 0; i < program.links.size(); ++i)
    text += sanitize_for_terminal(program.links[i].name) + ": " + describe_link(contacts_[i], program.links[i], program) + "\n";
  return text;
}

std::string ContactSummary::report(const haptics::HapticProgram& program, const haptics::ReplayStats& stats) const {
  std::string text = fmt::format("{} ticks, {:.3f} us each (p99 {:.3f} us), force up to {:.3g} N, {:.3g} N on average\n", stats.ticks,
                                 1e-3 * stats.tick_ns_p50, 1e-3 * stats.tick_ns_p99, max_force_n_,
                                 stats.ticks > 0 ? force_sum_n_ / static_cast<double>(stats.ticks) : 0.0);
  if (program.links.empty()) text += "  the chain is empty: there are no forces\n";
  for (std::size_t i = 0; i < program.links.size(); ++i) {
    const LinkContact& touch = contacts_[i];
    text += fmt::format("  {}: {}. Gap {:.4g} units; ticks", sanitize_for_terminal(program.links[i].name),
                        describe_link(touch, program.links[i], program), touch.max_gap);
    for (const auto& [word, count] : touch.statuses) text += fmt::format(" {} {}", word, count);
    text += '\n';
  }
  return text;
}

}  // namespace catena::app

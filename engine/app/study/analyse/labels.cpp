// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>

#include "engine/app/study/analyse/analysis.h"

namespace catena::app::analysis {

const char* to_string(Quantity q) {
  constexpr const char* words[] = {"error", "time", "error_deviation", "time_deviation", "slope"};
  return words[static_cast<int>(q)];
}

const char* quantity_label(Quantity q) {
  constexpr const char* names[] = {"error", "time", "deviation of the error", "deviation of the time", "slope of log error on log time"};
  return names[static_cast<int>(q)];
}

const char* quantity_unit(Quantity q) {
  constexpr const char* units[] = {"mm", "s", "mm", "s", ""};
  return units[static_cast<int>(q)];
}

const char* to_string(Verdict verdict) {
  constexpr const char* words[] = {"supported", "not supported", "not testable"};
  return words[static_cast<int>(verdict)];
}

std::string format_p(double p) {
  if (!std::isfinite(p)) return "-";
  if (p < 1e-15) return "< 1e-15";
  return p < 0.001 ? fmt::format("{:.1e}", p) : fmt::format("{:.3g}", p);
}

std::string format_p_values(double p, double corrected) {
  const std::string text = format_p(p);
  return fmt::format("p {}{} (corrected {})", text.starts_with('<') ? "" : "= ", text, format_p(corrected));
}

std::string FindingResult::text() const {
  std::string all = supported_count.empty() ? "" : supported_count + ": ";
  for (std::size_t i = 0; i < details.size(); ++i) all += (i > 0 ? "; " : "") + details[i];
  return all;
}

std::string task_condition_label(const Study& study, const TaskCondition& task_condition) {
  return study.tasks[static_cast<std::size_t>(task_condition.task)].name + ", " +
         study.conditions[static_cast<std::size_t>(task_condition.condition)].name;
}

std::string difference_label(const Study& study, const PairedComparison& paired) {
  const bool tasks = paired.first.task != paired.second.task;
  const auto name = [&](const TaskCondition& p) {
    return tasks ? study.tasks[static_cast<std::size_t>(p.task)].name : study.conditions[static_cast<std::size_t>(p.condition)].name;
  };
  return name(paired.first) + " - " + name(paired.second);
}

std::string comparison_text(const Study& study, const PairedComparison& paired) {
  if (!paired.test) return paired.skip_reason;
  const statistics::PairedTest& t = *paired.test;
  const std::string unit = quantity_unit(paired.quantity);
  return fmt::format("{} = {:.3g}{} ({:.3g} to {:.3g}), t({:g}) = {:.2f}, {}, d_z = {:.2f}", difference_label(study, paired), t.difference,
                     unit.empty() ? "" : " " + unit, t.low, t.high, t.df, t.t, format_p_values(t.p, paired.corrected_p), t.effect);
}

}  // namespace catena::app::analysis

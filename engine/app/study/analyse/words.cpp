#include <fmt/format.h>

#include <cmath>

#include "engine/app/study/analyse/analysis.h"

namespace catena::app::analysis {

const char* quantity_word(Quantity q) {
  constexpr const char* words[] = {"error", "time", "error_deviation", "time_deviation", "slope"};
  return words[static_cast<int>(q)];
}

const char* quantity_name(Quantity q) {
  constexpr const char* names[] = {"error", "time", "deviation of the error", "deviation of the time", "slope of log error on log time"};
  return names[static_cast<int>(q)];
}

const char* unit_of(Quantity q) {
  constexpr const char* units[] = {"mm", "s", "mm", "s", ""};
  return units[static_cast<int>(q)];
}

const char* verdict_word(Verdict verdict) {
  constexpr const char* words[] = {"supported", "not supported", "not testable"};
  return words[static_cast<int>(verdict)];
}

std::string p_text(double p) {
  if (!std::isfinite(p)) return "-";
  if (p < 1e-15) return "< 1e-15";
  return p < 0.001 ? fmt::format("{:.1e}", p) : fmt::format("{:.3g}", p);
}

std::string p_words(double p, double corrected) {
  const std::string text = p_text(p);
  return fmt::format("p {}{} (corrected {})", text.starts_with('<') ? "" : "= ", text, p_text(corrected));
}

std::string Judged::text() const {
  std::string all = count.empty() ? "" : count + ": ";
  for (std::size_t i = 0; i < numbers.size(); ++i) all += (i > 0 ? "; " : "") + numbers[i];
  return all;
}

std::string place_text(const Study& study, const Place& place) {
  return study.tasks[static_cast<std::size_t>(place.task)].name + ", " + study.conditions[static_cast<std::size_t>(place.condition)].name;
}

std::string difference_text(const Study& study, const Paired& paired) {
  const bool tasks = paired.first.task != paired.second.task;
  const auto name = [&](const Place& p) {
    return tasks ? study.tasks[static_cast<std::size_t>(p.task)].name : study.conditions[static_cast<std::size_t>(p.condition)].name;
  };
  return name(paired.first) + " - " + name(paired.second);
}

std::string paired_text(const Study& study, const Paired& paired) {
  if (!paired.test) return paired.why_not;
  const statistics::PairedTest& t = *paired.test;
  const std::string unit = unit_of(paired.quantity);
  return fmt::format("{} = {:.3g}{} ({:.3g} to {:.3g}), t({:g}) = {:.2f}, {}, d_z = {:.2f}", difference_text(study, paired), t.difference,
                     unit.empty() ? "" : " " + unit, t.low, t.high, t.df, t.t, p_words(t.p, paired.corrected), t.effect);
}

}  // namespace catena::app::analysis

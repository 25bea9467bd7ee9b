// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/app/tuning/report/report.h"
#include "engine/app/tuning/report/results_dir.h"
#include "engine/base/json.h"
#include "engine/base/json_text.h"
#include "engine/base/text.h"

namespace catena::app::tuning {
namespace {

constexpr const char* kMark = "catena_tradeoff";
constexpr int kFormat = 1;
constexpr std::size_t kMaxCurves = 256, kMaxPoints = 4096, kMaxId = 200;  // limits on a file that is read

std::string json_of(const Point& p) {
  return fmt::format(
      R"({{"setting": {}, "write": {}, "series": {}, "error": {}, "work": {}, "time": {{"median": {}, "low": {}, "high": {}, "repeats": {}}}, "bytes": {}, "offered": {}, "more": {}}})",
      json_string(p.setting), json_string(p.config_text), json_string(p.series), json_number(p.error), json_number(p.work),
      json_number(p.time.median), json_number(p.time.lower_quartile), json_number(p.time.upper_quartile), p.time.repeats,
      json_number(p.bytes), p.is_selectable, json_list(p.extra_values, json_number));
}

constexpr const char* kCosts[] = {"time", "work", "bytes"};

/// Pairs of JSON key and member for the text members of a curve.
template <class AnyCurve>
auto words_of(AnyCurve& c) {
  return std::to_array({std::pair{"id", &c.id},
                        {"part", &c.category},
                        {"title", &c.title},
                        {"what", &c.description},
                        {"error_name", &c.error_name},
                        {"work_name", &c.work_name},
                        {"time_name", &c.time_name},
                        {"bytes_name", &c.bytes_name},
                        {"floor_name", &c.discretization_error_name},
                        {"floor_from", &c.discretization_error_method},
                        {"reference", &c.reference},
                        {"why", &c.choice_reason}});
}

std::string json_of(const Curve& c) {
  std::string text = "  {";
  const auto add = [&](const char* key, const std::string& value) {
    text += (text.size() > 3 ? ",\n   \"" : "\"") + std::string(key) + "\": " + value;
  };
  for (const auto& [key, word] : words_of(c)) add(key, json_string(*word));
  add("more", json_list(c.extra_columns, json_string));
  add("floor", json_number(c.discretization_error));
  add("reference_error", json_number(c.reference_error));
  add("cost", json_string(kCosts[static_cast<int>(c.cost)]));
  add("current", std::to_string(c.current));
  add("chosen", std::to_string(c.chosen));
  add("front", json_list(c.front, [](int i) { return std::to_string(i); }));
  std::string points;
  for (const Point& p : c.points) points += (points.empty() ? "\n     " : ",\n     ") + json_of(p);
  add("points", "[" + points + "]");
  return text + "}";
}

Result<double> number_at(const json::Node& node, std::string_view key) {
  const json::Node* found = node.find(key);
  if (found == nullptr || found->is_null()) return kNotMeasured;
  return json::as_number(*found, key);
}

/// Reads an index of a point, or -1.
Result<int> index_at(const json::Node& node, std::string_view key, std::size_t count) {
  return json::get_integer(node, key, -1, -1, static_cast<int>(count) - 1);
}

Result<std::vector<json::Node>> items_of(const json::Node& node, std::string_view key) {
  const json::Node* found = node.find(key);
  if (found == nullptr || found->kind != json::Kind::array)
    return json::error_at(json::member_or_parent(node, key), "\"" + std::string(key) + "\": a list was expected");
  return found->items;
}

Result<Point> read_point(const json::Node& node) {
  Point p;
  CATENA_TRY(p.setting, json::require_string(node, "setting"));
  CATENA_TRY(p.config_text, json::get_string(node, "write", ""));
  CATENA_TRY(p.series, json::get_string(node, "series", ""));
  CATENA_TRY(p.error, number_at(node, "error"));
  CATENA_TRY(p.work, number_at(node, "work"));
  CATENA_TRY(p.bytes, number_at(node, "bytes"));
  if (const json::Node* time = node.find("time")) {
    CATENA_TRY(p.time.median, number_at(*time, "median"));
    CATENA_TRY(p.time.lower_quartile, number_at(*time, "low"));
    CATENA_TRY(p.time.upper_quartile, number_at(*time, "high"));
    CATENA_TRY(p.time.repeats, json::get_integer(*time, "repeats", 0, 0, 1'000'000));
  }
  CATENA_TRY(p.is_selectable, json::get_boolean(node, "offered", true));
  CATENA_TRY(const std::vector<json::Node> more, items_of(node, "more"));
  for (const json::Node& item : more) p.extra_values.push_back(item.kind == json::Kind::number ? item.number : kNotMeasured);
  return p;
}

Result<Curve> read_curve(const json::Node& node) {
  Curve c;
  for (const auto& [key, word] : words_of(c)) {
    CATENA_TRY(*word, json::require_string(node, key));
  }
  // the id names the file of the curve's table: it must not lead to another folder
  const bool plain = !c.id.empty() && c.id.size() <= kMaxId && c.id.front() != '.' &&
                     std::ranges::none_of(c.id, [](unsigned char letter) { return letter == '/' || letter < ' '; });
  if (!plain) return json::error_at(node, "\"id\" is " + in_quotes(c.id) + "; the name of a table was expected");
  if (c.category != "data" && c.category != "hand" && c.category != "eye")
    return json::error_at(node, "\"part\" is " + in_quotes(c.category) + "; data, hand or eye was expected");
  CATENA_TRY(const std::vector<json::Node> more, items_of(node, "more"));
  for (const json::Node& item : more) {
    CATENA_TRY(const std::string name, json::as_string(item, "more"));
    c.extra_columns.push_back(name);
  }
  CATENA_TRY(const std::vector<json::Node> points, items_of(node, "points"));
  if (points.size() > kMaxPoints)
    return json::error_at(node, fmt::format("\"points\" has {}; at most {} were expected", points.size(), kMaxPoints));
  for (const json::Node& item : points) {
    CATENA_TRY(Point point, read_point(item));
    point.extra_values.resize(c.extra_columns.size(), kNotMeasured);
    c.points.push_back(std::move(point));
  }
  CATENA_TRY(c.discretization_error, number_at(node, "floor"));
  CATENA_TRY(c.reference_error, number_at(node, "reference_error"));
  CATENA_TRY(const int cost, json::get_choice(node, "cost", 0, {std::begin(kCosts), std::end(kCosts)}));
  c.cost = static_cast<CostKind>(cost);
  CATENA_TRY(c.current, index_at(node, "current", c.points.size()));
  CATENA_TRY(c.chosen, index_at(node, "chosen", c.points.size()));
  CATENA_TRY(const std::vector<json::Node> front, items_of(node, "front"));
  for (const json::Node& item : front) {
    CATENA_TRY(const double i, json::as_number(item, "front", json::NumberRange::non_negative));
    if (i >= static_cast<double>(c.points.size())) return json::error_at(item, "\"front\": the index of a point was expected");
    c.front.push_back(static_cast<int>(i));
  }
  return c;
}

}  // namespace

std::string to_json(const Report& report) {
  std::string curves;
  for (const Curve& c : report.curves) curves += (curves.empty() ? "\n" : ",\n") + json_of(c);
  std::string about;
  for (const auto& [key, value] : report.metadata) about += (about.empty() ? "" : ", ") + json_string(key) + ": " + json_string(value);
  return fmt::format("{{\"{}\": {},\n \"source\": {},\n \"about\": {{{}}},\n \"left_out\": {},\n \"curves\": [{}]}}\n", kMark, kFormat,
                     json_string(report.source), about, json_list(report.skipped, json_string), curves);
}

bool is_report(const std::string& path) {
  if (!has_extension(path, ".json")) return false;
  const auto root = json::read(path);
  return root && root->find(kMark) != nullptr;
}

namespace {

Result<Report> to_report(const json::Node& root) {
  if (root.find(kMark) == nullptr) return json::error_at(root, "is not a report; a tradeoff.json of `catena tradeoff` was expected");
  CATENA_CHECK(json::get_integer(root, kMark, kFormat, kFormat, kFormat));
  Report report;
  CATENA_TRY(report.source, json::require_string(root, "source"));
  if (const json::Node* about = root.find("about"))
    for (const auto& [key, value] : about->members) report.metadata.emplace_back(key, value.string);
  CATENA_TRY(const std::vector<json::Node> left_out, items_of(root, "left_out"));
  for (const json::Node& item : left_out) report.skipped.push_back(item.string);
  CATENA_TRY(const std::vector<json::Node> curves, items_of(root, "curves"));
  if (curves.size() > kMaxCurves)
    return json::error_at(root, fmt::format("\"curves\" has {}; at most {} were expected", curves.size(), kMaxCurves));
  for (const json::Node& item : curves) {
    CATENA_TRY(Curve curve, read_curve(item));
    if (find_curve(&report, curve.id) != nullptr)
      return json::error_at(item, "\"id\" is " + in_quotes(curve.id) + " a second time; unique ids were expected");
    report.curves.push_back(std::move(curve));
  }
  return report;
}

}  // namespace

Result<Report> read_report(const std::string& path) {
  CATENA_TRY(const json::Node root, json::read(path));
  return to_report(root);
}

Result<Report> parse_report(std::string_view text, const std::string& file) {
  CATENA_TRY(const json::Node root, json::parse(text, file));
  return to_report(root);
}

const Curve* find_curve(const Report* report, const std::string& id) {
  if (report == nullptr) return nullptr;
  for (const Curve& curve : report->curves)
    if (curve.id == id) return &curve;
  return nullptr;
}

std::string to_csv(const Curve& c) {
  std::string header = "setting,series,error,work,time_median,time_low,time_high,repeats,bytes,front,chosen";
  for (const std::string& name : c.extra_columns) header += "," + csv_text(name);
  CsvTable table(header);
  for (std::size_t i = 0; i < c.points.size(); ++i) {
    const Point& p = c.points[i];
    table.add(csv_text(p.setting))
        .add(csv_text(p.series))
        .add(p.error)
        .add(p.work)
        .add(p.time.median)
        .add(p.time.lower_quartile)
        .add(p.time.upper_quartile);
    table.add(p.time.repeats).add(p.bytes);
    table.add(is_on_front(c, static_cast<int>(i)) ? 1 : 0).add(static_cast<int>(i) == c.chosen ? 1 : 0);
    for (const double value : p.extra_values) table.add(value);
    table.end_row();
  }
  return table.text();
}

}  // namespace catena::app::tuning

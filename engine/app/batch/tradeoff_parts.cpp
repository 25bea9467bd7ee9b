// SPDX-License-Identifier: MIT
#include "engine/app/batch/tradeoff_parts.h"

#include <algorithm>
#include <filesystem>
#include <numeric>

#include "engine/app/cli/io_conflicts.h"
#include "engine/app/tuning/report/report_folder.h"
#include "engine/base/json.h"
#include "engine/base/json_text.h"
#include "engine/base/text.h"

namespace catena::app {

namespace {

using tuning::Report;

constexpr int kMaxMeasurement = 1000;

/// Reads the list of measurements at `key`, one for each of `count` curves or sentences.
Result<std::vector<int>> read_items(const json::Node& root, const char* key, std::size_t count) {
  const json::Node* list = root.find(key);
  if (list == nullptr || list->kind != json::Kind::array || list->items.size() != count)
    return json::error_at(root, std::string("\"") + key + "\": a list of " + std::to_string(count) + " numbers was expected");
  std::vector<int> items;
  for (const json::Node& node : list->items) {
    CATENA_TRY(const double number, json::as_number(node, key));
    if (!(number >= -1 && number <= kMaxMeasurement)) return json::error_at(node, "the index of a measurement was expected");
    items.push_back(static_cast<int>(number));
  }
  return items;
}

Result<MeasuredReport> read_tradeoff_part(const Part& part) {
  CATENA_TRY(std::string text, read_text_file(part.path, "a part of a report", kMaxJsonBytes));
  text.resize(std::min<std::size_t>(text.size(), part.bytes));
  const std::size_t line_end = std::min(text.find('\n'), text.size());
  CATENA_TRY(const json::Node root, json::parse(std::string_view(text).substr(0, line_end), part.path));
  MeasuredReport measured;
  CATENA_TRY(measured.report, tuning::parse_report(std::string_view(text).substr(line_end), part.path));
  CATENA_TRY(measured.curve_items, read_items(root, "curve_items", measured.report.curves.size()));
  CATENA_TRY(measured.skipped_items, read_items(root, "skipped_items", measured.report.skipped.size()));
  return measured;
}

/// Merges what the shards state about their machines: values that differ are listed, of the dates the last is taken.
void merge_metadata(Report& into, const Report& from) {
  for (std::size_t i = 0; i < from.metadata.size(); ++i) {
    const auto& [key, value] = from.metadata[i];
    const auto known = std::ranges::find(into.metadata, key, &std::pair<std::string, std::string>::first);
    if (known == into.metadata.end()) {
      // after the entry that it follows in its own report
      const auto before = i == 0
                              ? into.metadata.end()
                              : std::ranges::find(into.metadata, from.metadata[i - 1].first, &std::pair<std::string, std::string>::first);
      into.metadata.insert(before == into.metadata.end() ? before : before + 1, from.metadata[i]);
    } else if (key == "date") {
      known->second = std::max(known->second, value);
    } else if (("; " + known->second + "; ").find("; " + value + "; ") == std::string::npos) {
      known->second += "; " + value;
    }
  }
}

/// Moves the elements of all parts into one list in the order of their measurements.
template <class T>
void merge_by_item(std::vector<T>& into, std::vector<std::pair<int, T>> all) {
  std::ranges::stable_sort(all, {}, &std::pair<int, T>::first);
  for (auto& [item, element] : all) into.push_back(std::move(element));
}

}  // namespace

std::string tradeoff_part_base(const std::string& folder) { return (std::filesystem::path(folder) / "tradeoff.part").string(); }

void write_tradeoff_part(PartWriter& part, const MeasuredReport& measured) {
  const auto number = [](int item) { return std::to_string(item); };
  part.write("{\"curve_items\": " + json_list(measured.curve_items, number) +
             ", \"skipped_items\": " + json_list(measured.skipped_items, number) + "}\n");
  part.write(tuning::to_json(measured.report));
}

Outcome merge_tradeoff_parts(const std::string& folder) {
  CATENA_TRY(const std::vector<Part> parts, find_parts(tradeoff_part_base(folder), "tradeoff"));
  Report report;
  std::vector<std::pair<int, tuning::Curve>> curves;
  std::vector<std::pair<int, std::string>> skipped;
  IoConflictChecker files;
  for (const Part& part : parts) {
    files.add_input(part.path);
    CATENA_TRY(MeasuredReport one, read_tradeoff_part(part));
    report.source = one.report.source;
    merge_metadata(report, one.report);
    for (std::size_t i = 0; i < one.curve_items.size(); ++i) {
      const auto same_id = [&](const auto& other) { return other.second.id == one.report.curves[i].id; };
      if (std::ranges::any_of(curves, same_id))
        return Error{part.path + ": has the curve " + in_quotes(one.report.curves[i].id) +
                     ", as another part does; each curve was expected in one part"};
      curves.emplace_back(one.curve_items[i], std::move(one.report.curves[i]));
    }
    for (std::size_t i = 0; i < one.skipped_items.size(); ++i) {
      std::pair<int, std::string> sentence{one.skipped_items[i], std::move(one.report.skipped[i])};
      // every shard reports the preparation
      if (sentence.first >= 0 || std::ranges::find(skipped, sentence) == skipped.end()) skipped.push_back(std::move(sentence));
    }
  }
  merge_by_item(report.curves, std::move(curves));
  merge_by_item(report.skipped, std::move(skipped));
  if (report.curves.empty())
    return Error{folder +
                 ": no part has a curve: " + (report.skipped.empty() ? "the scene has no items of this kind." : report.skipped.front())};
  for (const std::string name : {"report.html", "tradeoff.json"}) files.add_output("OUTPUT", folder + "/" + name);
  CATENA_CHECK(files.check());
  CATENA_TRY(ResultsDir results, ResultsDir::open(folder));
  CATENA_CHECK(tuning::write_report(results, report, nullptr));
  tuning::print_report(results, folder, report);
  return Done{};
}

}  // namespace catena::app

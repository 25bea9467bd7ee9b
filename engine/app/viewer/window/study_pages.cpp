// SPDX-License-Identifier: MIT
#include "engine/app/viewer/window/study_pages.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>

#include "engine/base/numbers.h"

namespace catena::app {

namespace {

constexpr ImGuiWindowFlags kStill = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                                    ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_NoFocusOnAppearing;
const ImVec4 kPaper(0.11f, 0.12f, 0.13f, 1), kInk(0.90f, 0.90f, 0.88f, 1), kQuiet(0.62f, 0.64f, 0.66f, 1), kChosen(0.20f, 0.45f, 0.70f, 1);
constexpr float kSmallArea = 640;   // pixels; narrower areas use the panels' text size
constexpr float kLineLetters = 34;  // width of a page's column, in text heights

/// The fonts of an area, as created by Gui.
struct Fonts {
  ImFont *small, *text, *heading;
};

Fonts fonts_for(const Area& area) {
  const auto& all = ImGui::GetIO().Fonts->Fonts;
  const auto font = [&](int k) { return all[std::min(k, all.Size - 1)]; };
  return area.width < kSmallArea ? Fonts{font(0), font(0), font(1)} : Fonts{font(0), font(1), font(2)};
}

void write(ImFont* font, const ImVec4& color, const std::string& text) {
  ImGui::PushFont(font);
  ImGui::PushStyleColor(ImGuiCol_Text, color);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopStyleColor();
  ImGui::PopFont();
}

void space(float lines) { ImGui::Dummy({0, lines * ImGui::GetFontSize()}); }

/// Draws a column in the middle of an opaque sheet, with the next action in its footer.
template <class Fill>
void sheet(const Area& area, const char* name, const std::string& foot, Fill&& fill) {
  const Fonts fonts = fonts_for(area);
  const auto width = static_cast<float>(area.width), height = static_cast<float>(area.height);
  const float column = std::min(0.86f * width, kLineLetters * fonts.text->FontSize), left = 0.5f * (width - column);
  ImGui::SetNextWindowPos({static_cast<float>(area.x), static_cast<float>(area.y)});
  ImGui::SetNextWindowSize({width, height});
  ImGui::PushStyleColor(ImGuiCol_WindowBg, kPaper);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {left, 0});
  if (ImGui::Begin(name, nullptr, kStill)) {
    ImGui::PushFont(fonts.text);
    ImGui::PushTextWrapPos(left + column);
    ImGui::SetCursorPosY(0.16f * height);
    fill(fonts, column);
    ImGui::SetCursorPosY(height - 2.5f * fonts.text->FontSize);
    write(fonts.small, kQuiet, foot);
    ImGui::PopTextWrapPos();
    ImGui::PopFont();
  }
  ImGui::End();
  ImGui::PopStyleVar(2);
  ImGui::PopStyleColor();
}

void draw_page(const InstructionPage& page, const Area& area, const char* name) {
  sheet(area, name, "Space: continue", [&](const Fonts& fonts, float) {
    write(fonts.heading, kInk, page.heading);
    for (const std::string& paragraph : page.paragraphs) {
      space(0.6f);
      write(fonts.text, kInk, paragraph);
    }
  });
}

/// Returns the answer without the number of its key at the beginning ("7 very much").
std::string words_of(const std::string& answer, std::size_t key) {
  const std::string number = std::to_string(key);
  if (!answer.starts_with(number)) return answer;
  return std::string(trim(std::string_view(answer).substr(number.size())));
}

bool is_scale(const std::vector<std::string>& answers) {
  for (std::size_t k = 0; k < answers.size(); ++k)
    if (!answers[k].starts_with(std::to_string(k + 1))) return false;
  return true;
}

/// Draws a box with its key in it, filled if it is selected.
void draw_box(const ImVec2& corner, float side, std::size_t key, bool chosen) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const std::string figure = std::to_string(key);
  const ImVec2 end(corner.x + side, corner.y + side), size = ImGui::CalcTextSize(figure.c_str());
  if (chosen) list.AddRectFilled(corner, end, ImGui::GetColorU32(kChosen), 4);
  list.AddRect(corner, end, ImGui::GetColorU32(kQuiet), 4);
  list.AddText({corner.x + 0.5f * (side - size.x), corner.y + 0.5f * (side - size.y)}, ImGui::GetColorU32(kInk), figure.c_str());
}

/// Draws boxes side by side with their meanings below.
void draw_scale(const std::vector<std::string>& answers, const std::string& entry, const Fonts& fonts, float column) {
  const auto count = static_cast<float>(answers.size());
  const float side = std::min(1.9f * fonts.text->FontSize, 0.8f * column / count), step = (column - side) / (count - 1);
  const ImVec2 at = ImGui::GetCursorPos(), screen = ImGui::GetCursorScreenPos();
  for (std::size_t k = 0; k < answers.size(); ++k) {
    const float x = static_cast<float>(k) * step;
    draw_box({screen.x + x, screen.y}, side, k + 1, entry == answers[k]);
    const std::string words = words_of(answers[k], k + 1);
    ImGui::PushFont(fonts.small);
    // keep the text within the column
    const float width = ImGui::CalcTextSize(words.c_str()).x, left = std::clamp(x + 0.5f * (side - width), 0.0f, column - width);
    ImGui::PopFont();
    ImGui::SetCursorPos({at.x + left, at.y + side + 0.3f * fonts.text->FontSize});
    write(fonts.small, kQuiet, words);
  }
}

void draw_choices(const std::vector<std::string>& answers, const std::string& entry, const Fonts& fonts) {
  const float side = 1.5f * fonts.text->FontSize;
  for (std::size_t k = 0; k < answers.size(); ++k) {
    const ImVec2 at = ImGui::GetCursorPos();
    draw_box(ImGui::GetCursorScreenPos(), side, k + 1, entry == answers[k]);
    ImGui::SetCursorPos({at.x + 1.4f * side, at.y + 0.5f * (side - fonts.text->FontSize)});
    write(fonts.text, kInk, words_of(answers[k], k + 1));
    ImGui::SetCursorPos({at.x, at.y + 1.3f * side});
  }
}

void draw_question(const StudyView& view, const Area& area, const char* name) {
  const study::Question& question = view.procedure.question();
  const std::vector<std::string>& answers = question.answers;
  const std::string& entry = view.procedure.typed_answer();
  const std::string foot =
      answers.empty() ? "Type your answer.  Enter: continue" : fmt::format("1 to {}: your answer.  Enter: continue", answers.size());
  sheet(area, name, foot, [&](const Fonts& fonts, float column) {
    write(fonts.small, kQuiet, fmt::format("Question {} of {}", view.procedure.question_index() + 1, view.procedure.question_count()));
    space(0.4f);
    write(fonts.text, kInk, question.question);
    space(1.2f);
    if (!answers.empty()) return is_scale(answers) ? draw_scale(answers, entry, fonts, column) : draw_choices(answers, entry, fonts);
    write(fonts.text, kInk, entry + "_");
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::GetWindowDrawList()->AddLine(at, {at.x + column, at.y}, ImGui::GetColorU32(kQuiet));
  });
}

/// Edge of the image at which a text is placed; the rest of the image stays free.
enum class Edge { top, bottom };
void draw_line(const std::string& words, const Area& area, const char* name, Edge edge = Edge::bottom) {
  const Fonts fonts = fonts_for(area);
  const double share = edge == Edge::top ? 0.02 : 0.98;
  const ImVec2 at(static_cast<float>(area.x + 0.5 * area.width), static_cast<float>(area.y + share * area.height));
  ImGui::SetNextWindowPos(at, 0, {0.5f, static_cast<float>(edge)});
  ImGui::SetNextWindowBgAlpha(0.7f);
  if (ImGui::Begin(name, nullptr, kStill | ImGuiWindowFlags_AlwaysAutoResize)) write(fonts.small, kInk, words);
  ImGui::End();
}

}  // namespace

void draw_study(const StudyView& view, const std::vector<Area>& areas) {
  for (std::size_t i = 0; i < areas.size(); ++i) {
    const std::string name = fmt::format("##study{}", i);
    switch (view.procedure.stage()) {
      case Procedure::Stage::page:
        draw_page(view.procedure.page(), areas[i], name.c_str());
        break;
      case Procedure::Stage::question:
        draw_question(view, areas[i], name.c_str());
        break;
      case Procedure::Stage::ready:
        draw_line(fmt::format("{}.  {}", view.procedure.trial_label(),
                              view.is_at_start ? "Space: begin" : "Move the cross to the start.  P: pause"),
                  areas[i], (name + "line").c_str());
        break;
      case Procedure::Stage::running:
        if (view.must_return_to_start) draw_line("Move back to the start", areas[i], (name + "line").c_str());
        break;
      case Procedure::Stage::finished:
        break;
    }
    if (!view.device_prompt.empty()) draw_line(view.device_prompt, areas[i], (name + "device").c_str(), Edge::top);
  }
}

}  // namespace catena::app

#include "engine/app/viewer/gui.h"

// ImGui's backend includes GLFW, which must not declare OpenGL
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <utility>

#include "render/text/font.h"

namespace catena::app {

namespace {

constexpr float kFontPixels = 15;

void choose_style(float scale) {
  ImGui::StyleColorsDark();
  ImGuiStyle& style = ImGui::GetStyle();
  style.WindowRounding = 4;
  style.FrameRounding = 3;
  style.GrabRounding = 3;
  style.WindowBorderSize = 0;
  style.Colors[ImGuiCol_WindowBg].w = 0.88f;
  style.ScaleAllSizes(scale);
}

}  // namespace

struct Gui::Parts {
  Window* window;
  std::shared_ptr<const render::UiTexture> font;
  float wheel = 0;  ///< turned in frames of catch_up
};

Gui::Gui(Window& window) : parts_(std::make_unique<Parts>(Parts{&window, nullptr})) {
  IMGUI_CHECKVERSION();
  ImGui::CreateContext();
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  io.LogFilename = nullptr;
  const float scale = window.content_scale();
  choose_style(scale);
  ImGui_ImplGlfw_InitForVulkan(window.native(), false);
  window.set_gui(true);

  // letters beyond ASCII that units and names use
  static const ImWchar kRanges[] = {0x20, 0x17f, 0x370, 0x3ff, 0x2010, 0x2027, 0x2070, 0x209f, 0x2190, 0x2193, 0x2200, 0x22ff, 0};
  const auto font = render::find_font("DejaVu Sans", false);
  const float pixels = std::max(8.0f, kFontPixels * scale);
  if (!font || io.Fonts->AddFontFromFileTTF(font->path.c_str(), pixels, nullptr, kRanges) == nullptr) io.Fonts->AddFontDefault();
  unsigned char* rgba = nullptr;
  int width = 0, height = 0;
  io.Fonts->GetTexDataAsRGBA32(&rgba, &width, &height);
  auto texture = std::make_shared<render::UiTexture>();
  texture->width = static_cast<std::uint32_t>(width);
  texture->height = static_cast<std::uint32_t>(height);
  texture->rgba.assign(rgba, rgba + std::size_t(4) * std::size_t(width) * std::size_t(height));
  io.Fonts->SetTexID(texture.get());
  io.Fonts->ClearTexData();
  parts_->font = std::move(texture);
}

Gui::~Gui() {
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
}

void Gui::catch_up(const std::vector<Input>& pieces, const std::function<void()>& make_panels) {
  if (pieces.size() < 2) return;
  const auto frame = [&](const Input& piece, double x, double y) {
    ImGui_ImplGlfw_NewFrame();
    ImGuiIO& io = ImGui::GetIO();
    io.DeltaTime = std::max(io.DeltaTime, 1e-6f);
    io.MousePos = {static_cast<float>(x), static_cast<float>(y)};
    io.MouseDown[0] = piece.left;
    io.MouseDown[1] = piece.right;
    io.MouseDown[2] = piece.middle;
    parts_->wheel += std::exchange(io.MouseWheel, 0.0f);
    ImGui::NewFrame();
    make_panels();
    ImGui::EndFrame();
  };
  const auto differ = [](const Input& a, const Input& b) { return a.left != b.left || a.right != b.right || a.middle != b.middle; };
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    const Input& piece = pieces[k];
    if (k > 0 && differ(piece, pieces[k - 1])) frame(piece, piece.x, piece.y);
    // where a drag ends before its button goes up
    const bool moved = piece.dx != 0 || piece.dy != 0;
    if (moved && k + 1 < pieces.size() && differ(piece, pieces[k + 1])) frame(piece, piece.x + piece.dx, piece.y + piece.dy);
  }
}

void Gui::begin() {
  ImGui_ImplGlfw_NewFrame();
  ImGui::GetIO().MouseWheel += std::exchange(parts_->wheel, 0.0f);
  ImGui::NewFrame();
  parts_->window->tell_releases();
}

render::UiItems Gui::end() {
  ImGui::Render();
  const ImDrawData* data = ImGui::GetDrawData();
  render::UiItems items;
  const ImVec2 scale = data->FramebufferScale;
  for (int n = 0; n < data->CmdListsCount; ++n) {
    const ImDrawList* list = data->CmdLists[n];
    const auto base_vertex = static_cast<std::uint32_t>(items.vertices.size());
    const auto base_index = static_cast<std::uint32_t>(items.indices.size());
    for (const ImDrawVert& v : list->VtxBuffer) items.vertices.push_back({v.pos.x * scale.x, v.pos.y * scale.y, v.uv.x, v.uv.y, v.col});
    items.indices.insert(items.indices.end(), list->IdxBuffer.begin(), list->IdxBuffer.end());
    for (const ImDrawCmd& command : list->CmdBuffer) {
      if (command.UserCallback != nullptr || command.ElemCount == 0) continue;
      items.draws.push_back(
          {parts_->font,
           {command.ClipRect.x * scale.x, command.ClipRect.y * scale.y, command.ClipRect.z * scale.x, command.ClipRect.w * scale.y},
           base_index + command.IdxOffset,
           command.ElemCount,
           base_vertex + command.VtxOffset});
    }
  }
  return items;
}

bool Gui::holds(double x, double y) const {
  const ImVec2 at(static_cast<float>(x), static_cast<float>(y));
  if (ImGui::GetTopMostPopupModal() != nullptr) return true;
  for (const ImGuiWindow* window : ImGui::GetCurrentContext()->Windows)
    if (window->WasActive && !window->Hidden && (window->Flags & ImGuiWindowFlags_NoMouseInputs) == 0 && window->Rect().Contains(at))
      return true;
  return false;
}

bool Gui::wants_keys() const { return ImGui::GetIO().WantTextInput || ImGui::GetTopMostPopupModal() != nullptr; }

void Gui::hide_pointer() { ImGui::SetMouseCursor(ImGuiMouseCursor_None); }

bool Gui::is_busy() const { return ImGui::IsAnyItemActive() || ImGui::GetIO().WantTextInput; }

}  // namespace catena::app

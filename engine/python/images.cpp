// SPDX-License-Identifier: MIT
/// catena.render: images with the depth and the object of every pixel. One renderer serves the calls of all threads, one at a time.
#include <algorithm>
#include <memory>
#include <mutex>

#include "engine/python/module.h"
#include "render/extract/extract.h"
#include "render/passes/renderer.h"

namespace catena::python {
namespace {

struct Shared {
  std::mutex turn;
  std::unique_ptr<render::Renderer> renderer;
};
Shared& shared() {
  // never destroyed; the renderer in it is freed before the interpreter ends, because the driver may be gone later
  static Shared* const one = new Shared;
  return *one;
}

struct Drawn {
  render::Image8 color;
  render::DepthImage depth;
  render::IdImage ids;
};

Drawn draw(const render::FramePacket& packet) {
  const std::lock_guard turn(shared().turn);
  std::unique_ptr<render::Renderer>& renderer = shared().renderer;
  const auto machine = []<class T>(Result<T> result) {
    if (!result) throw Failure(Error{result.error().message, true});
    return std::move(*result);
  };
  if (renderer && renderer->device().is_lost()) renderer.reset();
  if (!renderer) renderer = machine(render::Renderer::create({}));
  unwrap(render::check_ray_items(packet));
  render::RenderSettings settings;
  settings.waits_for_pages = true;
  machine(renderer->draw(packet, settings));
  return {machine(renderer->read_back()), machine(renderer->read_depth()), machine(renderer->read_ids())};
}

template <class T, class From>
py::array_t<T> image(const std::vector<From>& from, std::uint32_t height, std::uint32_t width, std::uint32_t channels) {
  std::vector<py::ssize_t> shape{height, width};
  if (channels > 1) shape.push_back(channels);
  py::array_t<T> array(shape);
  std::copy(from.begin(), from.end(), array.mutable_data());
  return array;
}

py::tuple render_arrays(const py::object& what, int width, int height, const py::object& fields) {
  if (width < 1 || height < 1 || width > 16384 || height > 16384)
    throw Failure(Error{"a picture of " + std::to_string(width) + " x " + std::to_string(height) +
                        " pixels; from 1 to 16384 each way were expected"});
  scene::Scene scene = to_scene(what, fields);
  render::FramePacket packet;
  Drawn drawn;
  {
    const py::gil_scoped_release unlocked;
    packet = unwrap(render::make_frame(scene, static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)));
    drawn = draw(packet);
  }
  py::dict objects;
  for (const render::ObjectName& object : packet.objects) objects[py::int_(object.id)] = py::make_tuple(object.kind, object.name);
  return py::make_tuple(image<std::uint8_t>(drawn.color.rgba, drawn.color.height, drawn.color.width, 4),
                        image<float>(drawn.depth.depth, drawn.depth.height, drawn.depth.width, 1),
                        image<std::uint32_t>(drawn.ids.ids, drawn.ids.height, drawn.ids.width, 1), objects);
}

}  // namespace

void add_images(py::module_& m) {
  m.def("_render", render_arrays, py::arg("what"), py::arg("width"), py::arg("height"), py::arg("fields"));
  py::module_::import("atexit").attr("register")(py::cpp_function([] {
    const std::lock_guard turn(shared().turn);
    shared().renderer.reset();
  }));
}

}  // namespace catena::python

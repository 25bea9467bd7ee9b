// SPDX-License-Identifier: MIT
/// List of passes, one per kind of item. renderer.cpp holds them in rendering order. Frame thread.
#pragma once
#include "render/passes/pass.h"

namespace catena::render {

// Shape passes (shape_passes.cpp): lit triangles and tubes, into the opaque targets.
extern const PassEntry kEnvironmentPass;  ///< bounding boxes, axes, the ground; not cut by clip planes
extern const PassEntry kWidgetPass;       ///< interactive widgets
extern const PassEntry kMeshPass;         ///< opaque meshes
extern const PassEntry kStreamlinePass;   ///< tubes and arrowheads of streamlines and curves
extern const PassEntry kGlyphPass;        ///< arrows of vector fields
extern const PassEntry kSpherePass;       ///< spheres of point sets (sphere_pass.cpp)
extern const PassEntry kCursorPass;       ///< probe, proxies, links, force; local flow indicators

/// Opaque isosurfaces: the rendered surface is the level set of the trilinear field itself, found along each pixel's ray from the cubic
/// polynomial of the cell (no triangles), written with its depth. Translucent isosurfaces are blended by the raycast, in depth order with
/// volumes.
extern const PassEntry kIsosurfacePass;

/// Opaque isosurfaces colored by another field: after they are rendered, their pixels get the color of the other field at the surface
/// point, lit by the surface normal. Every such item needs an id of its own (not 0).
extern const PassEntry kSurfaceColorPass;

/// Opaque slices (slice.h).
extern const PassEntry kSlicePass;

/// Halos of streamlines and curves (FramePacket::has_line_halos): what lies behind a line is darkened beside it, the more the farther it is
/// behind (shaders/passes/line_halos.frag). Depth and id images are not affected.
extern const PassEntry kLineHaloPass;

/// Translucent meshes and slices as layers, by depth peeling from front to back: layer k holds, at every pixel, the k-th nearest fragment
/// in front of the opaque depth; the raycast blends the layers in depth order with volumes and translucent isosurfaces (Frame::layers).
///   layer k: all items are rendered; fragments not behind layer k - 1 are discarded, the depth buffer keeps the nearest
/// Depths are compared as stored in the depth buffer, equal ones by id: coincident fragments of different objects are all kept. At most
/// MAX_LAYERS. If several fragments may remain for the last layer (tail), it is their mean: alpha = 1 - prod (1 - a_i), colors weighted by
/// -ln (1 - a_i), depth of the nearest; exact if one fragment remains, always independent of the rendering order. The images exist only
/// while the packet has translucent items.
extern const PassEntry kLayersPass;
/// Returns whether the packet has translucent items for the layers.
bool needs_layers(const FramePacket& packet);
/// Returns whether the mesh belongs to the layers.
bool is_translucent(const MeshItem& item);

/// Everything that a ray blends, in depth order: volumes, translucent isosurfaces and the layers of other passes, in front of the opaque
/// depth. A single volume is rendered by the fast raycast if the settings request it and it can be packed (render/raycast/fast_volume.h).
/// Everything else is rendered by the exact raycast (volume.h), also volumes for which the fast raycast has no memory; that takes longer
/// and is reported in RenderStats::warnings.
extern const PassEntry kRaycastPass;
/// Returns whether the fast raycast can render the packet: exactly one volume, or several in the same pages, in composite projection, no
/// translucent isosurface, a grid that can be packed, and an appearance that depends on the value alone.
bool supports_fast_raycast(const vk::Device& device, const FramePacket& packet);

/// X-ray overlay: the cursor where something occludes it (CursorItem::show_occluded). Its triangles are rendered a second time, with a
/// depth buffer of their own, into target::occluded_overlay.
///   alpha    FACE_ALPHA where the surface faces the camera .. RIM_ALPHA at the silhouette (outline)
///   weight   1 behind something opaque: another object's id is at the pixel; else the alpha of the volume there, by which `compose`
///            multiplies
/// A cursor that nothing occludes therefore leaves the image unchanged. Depth and id images are not affected.
extern const PassEntry kOccludedOverlayPass;

/// Composition of x-ray overlay over volume over opaque over background, into the finished image (output format, straight alpha).
extern const PassEntry kComposePass;

/// Vignette: the finished image darkened away from the view axis (FramePacket::vignette), which reduces the visible motion in the
/// periphery:  alpha of black = strength smoothstep(tan inner, tan outer, tan angle). Perspective views only.
extern const PassEntry kVignettePass;
inline constexpr double kVignetteInner_deg = 12, kVignetteOuter_deg = 30;

/// Overlay: text and flat shapes over the finished image: scalar bars, labels, title, orientation marker, status. They are rendered into a
/// separate image (premultiplied) and blended over the finished one (straight alpha), which is correct for opaque and for transparent
/// images. Without items there is no pass. Without a font there is no text, and the pass's warning states why.
extern const PassEntry kOverlayPass;

}  // namespace catena::render

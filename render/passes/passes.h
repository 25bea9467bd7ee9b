/// The passes: one a kind of thing that a picture can hold. renderer.cpp holds them in the order of drawing. Frame thread.
#pragma once
#include "render/passes/pass.h"

namespace catena::render {

// PrimitiveKinds (shape_passes.cpp): lit triangles and tubes, into the opaque targets.
extern const PassEntry kEnvironmentPass;  ///< bounding boxes, axes, the ground; clip planes do not touch them
extern const PassEntry kWidgetPass;       ///< what the hand takes hold of
extern const PassEntry kMeshPass;         ///< the opaque meshes
extern const PassEntry kStreamlinePass;   ///< tubes and their arrowheads
extern const PassEntry kGlyphPass;        ///< arrows of vectors
extern const PassEntry kSpherePass;       ///< balls of point sets (ball_pass.cpp)
extern const PassEntry kCursorPass;       ///< probe, proxies, links, force; local indicators

/// Opaque isosurfaces: the drawn surface is the level set of the trilinear field itself, found along each pixel's ray from the
/// cubic of the cell (no triangles), written with its depth. Translucent ones are drawn by the raycast, in order with volumes.
extern const PassEntry kIsosurfacePass;

/// Opaque isosurfaces coloured by another field: after they are drawn, the pixels that show one get the other field's colour at their
/// place, lit by the surface's normal. Needs an id of its own (not 0) in every such item.
extern const PassEntry kSurfaceColorPass;

/// Opaque slices (slice.h).
extern const PassEntry kSlicePass;

/// Translucent meshes and slices as layers, peeled front to back: layer k holds, at every pixel, the k-th nearest of what lies in
/// front of the opaque depth; the raycast blends them in order with volumes and translucent isosurfaces (Frame::layers).
///   layer k: all is drawn again, what is not behind layer k - 1 left out, the nearest kept by a depth buffer
/// Depths are compared as the depth buffer holds them, equal ones by id: coincident things of different objects are both kept.
/// At most MAX_LAYERS. The last one, if more than one thing may lie in it, is their mean: alpha = 1 - prod (1 - a_i), colours
/// weighted by -ln (1 - a_i), depth of the nearest; exact with one thing left, independent of the order of drawing always.
/// Images exist only while something translucent is in the packet.
extern const PassEntry kLayersPass;
/// Whether the packet holds something translucent that layers are for.
bool needs_layers(const FramePacket& packet);
/// In the layers.
bool is_translucent(const MeshItem& item);

/// Everything that a ray blends, in order: volumes, translucent isosurfaces and the layers of other passes, in front of the opaque depth. A
/// lone volume goes to the fast raycast where the settings ask for it and it can be packed (render/raycast/fast_volume.h); all else to the
/// exact one (volume.h), and so does what there is no memory for: the picture is slower then, and the stats' notes say so.
extern const PassEntry kRaycastPass;
/// What the fast raycast draws: one volume and no translucent isosurface, of a grid that can be packed; composite, its look a matter of its
/// value alone.
bool supports_fast_raycast(const vk::Device& device, const FramePacket& packet);

/// The hand where something hides it (CursorItem::ghost): its triangles once more, with a depth buffer of their own, into target::ghost.
///   alpha    kGhostFace where the surface faces the eye .. kGhostRim at its silhouette, an outline
///   hidden   1 behind something opaque: another object's id is at the pixel; else the alpha of the volume there, which `compose`
///   multiplies
/// So a hand that nothing hides leaves the picture as it is. Depths and ids do not know of it.
extern const PassEntry kOccludedOverlayPass;

/// Ghost over volume over opaque over background, into the finished picture (RGBA8, straight alpha).
extern const PassEntry kComposePass;

/// The finished picture darkened away from the eye's axis (FramePacket::vignette), so that a person whom the world moves around sees less
/// of it go by:  alpha of black = strength smoothstep(tan inner, tan outer, tan angle). Perspective views alone.
extern const PassEntry kVignettePass;
inline constexpr double kVignetteInner_deg = 12, kVignetteOuter_deg = 30;

/// Text and flat shapes over the finished picture: scalar bars, labels, title, orientation marker, status. They are drawn into an image
/// of their own (premultiplied) and blended into the picture (straight alpha), so that both opaque and transparent pictures are right.
/// Without an item there is no pass. Without a font there is no text, and the pass's note says why.
extern const PassEntry kOverlayPass;

}  // namespace catena::render

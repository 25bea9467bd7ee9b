// SPDX-License-Identifier: MIT
/// Error of an image compared with a converged reference, in perceptually relevant measures. Both are rendered without a background
/// (straight alpha, 8 bits) and compared over one color. Any thread.
///   covered     pixels where the alpha of either image is 1/255 or more
///   rmse        of red, green and blue over the covered pixels, in 1/255
///   p999        99.9 percentile of the maximum of a covered pixel's three differences, in 1/255
///   thin features  of the reference's brightness (mean of the three channels): white top-hat, brightness minus its opening by a disc of
///               radius 3 pixels, above 8/255; its 8-connected parts of 20 pixels or more. Retained share of a part: the sum over it of the
///               minimum of both images' top-hats, divided by that of the reference
///   flicker     in a sequence: RMSE of the change of the difference from one frame to the next, over pixels covered in either frame
#pragma once
#include <array>
#include <vector>

#include "render/image/image.h"

namespace catena::render {

/// Errors of the covered pixels, in pixel order, of images that are composited over their background already.
struct PixelErrors {
  std::vector<double> squared;      ///< mean of the three squared differences, (1/255)^2
  std::vector<double> max_channel;  ///< maximum of the three differences, 1/255
};
/// Returns the errors of the covered pixels of two images of equal size.
PixelErrors compute_covered_errors(const Image8& rendered, const Image8& converged);

/// Error measures of one image.
struct ImageError {
  double rmse = 0, p999 = 0;     ///< 1/255
  double covered_share = 0;      ///< covered share of the pixels
  int thin_feature_count = 0;    ///< number of thin features in the reference
  double min_thin_retained = 1;  ///< retained share of the worst thin feature
  double thin_retained = 1;      ///< retained share of all thin features together
};

/// Compares two images of equal size; `background`: display values, 0 to 1.
ImageError measure_error(const Image8& rendered, const Image8& converged, const std::array<float, 3>& background = {});

/// Returns the flicker of a sequence of at least two frames, given their references, 1/255.
double measure_flicker(const std::vector<Image8>& frames, const std::vector<Image8>& converged,
                       const std::array<float, 3>& background = {});

/// Returns the flicker of two frames and their references, all composited over their background already, 1/255.
double measure_frame_flicker(const Image8& last, const Image8& last_converged, const Image8& now, const Image8& converged);

/// Returns the image composited over a color; alpha is unchanged, so that the coverage remains known.
Image8 composite_over(const Image8& rendered, const std::array<float, 3>& background);

}  // namespace catena::render

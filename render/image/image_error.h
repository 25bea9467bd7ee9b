/// How far a picture is from the converged one, where people look. Both are drawn without a background (straight alpha, 8 bits) and
/// compared over one colour. Any thread.
///   covered     pixels where the alpha of either picture is 1/255 or more
///   rmse        of red, green and blue over the covered pixels, in 1/255
///   p999        the 99.9 percentile of the largest of a covered pixel's three differences, in 1/255
///   thin parts  of the converged picture's brightness (the mean of the three): the white top-hat, brightness less its opening by a disc of
///               radius 3 pixels, above 8/255; its 8-connected parts of 20 pixels or more. What is kept of one: the sum over it of the
///               lesser of both pictures' top-hats, by that of the converged one
///   flicker     along a sequence: the RMSE of the change of the difference from one frame to the next, over pixels covered in either frame
#pragma once
#include <array>
#include <vector>

#include "render/image/image.h"

namespace catena::render {

/// Of every covered pixel, in the order of the pixels; of pictures that lie over their background already.
struct PixelErrors {
  std::vector<double> squared;      ///< the mean of the three squared differences, (1/255)^2
  std::vector<double> max_channel;  ///< of the three, 1/255
};
PixelErrors compute_covered_errors(const Image8& picture, const Image8& converged);

struct ImageError {
  double rmse = 0, p999 = 0;     ///< 1/255
  double covered_share = 0;      ///< share of the pixels
  int thin_feature_count = 0;    ///< of the converged picture
  double min_thin_retained = 1;  ///< of the part that lost most
  double thin_retained = 1;      ///< of all parts together
};

/// Of pictures of one size; `background`: display values, 0 to 1.
ImageError measure_error(const Image8& picture, const Image8& converged, const std::array<float, 3>& background = {});

/// Frames and their converged pictures, in turn, two at least.
double measure_flicker(const std::vector<Image8>& frames, const std::vector<Image8>& converged,
                       const std::array<float, 3>& background = {});

/// Of two frames that lie over their background already, and their converged pictures.
double measure_frame_flicker(const Image8& last, const Image8& last_converged, const Image8& now, const Image8& converged);

/// Over a colour; alpha stays, so that what is covered is known.
Image8 composite_over(const Image8& picture, const std::array<float, 3>& background);

}  // namespace catena::render

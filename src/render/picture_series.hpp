// The pictures of a run: one of each wanted style at every output time, all with the same colour range.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "gaussdrift/case.hpp"
#include "gaussdrift/frame.hpp"

namespace gaussdrift::render {

/// images/surface_0000.png, ... The range is that of the first frame, with round ends. If a later frame leaves it by
/// more than a hundredth, all pictures are drawn again at the end, with the wider range (in 3D from every second,
/// third, ... point where an axis has more than 128). Errors have a range of their own, as far below 0 as above;
/// styles that show them need frames with an exact density.
std::unique_ptr<Observer> picture_series(const std::filesystem::path& folder, const std::vector<PictureStyle>& styles,
                                         std::string title);

}  // namespace gaussdrift::render

// view.py: opens the files of a run in ParaView.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "gaussdrift/case.hpp"

namespace gaussdrift::write {

struct ViewFile {
  std::string_view name;   // "view.py"
  std::string_view bytes;  // as it stands in src/write/paraview/
};

/// Generated from src/write/paraview/ by cmake/EmbedFiles.cmake.
const std::vector<ViewFile>& view_files();

/// The script. It has no text of the case in it; what it shows of that it reads from summary.json.
std::string view_script(const Case& spec);

}  // namespace gaussdrift::write

// The study as a page of its own, study.html.
#pragma once

#include <string_view>
#include <vector>

namespace gaussdrift::study {

struct PageFile {
  std::string_view name;   // "study.css"
  std::string_view bytes;  // as it stands in src/study/page/
};

/// Generated from src/study/page/ by cmake/EmbedFiles.cmake.
const std::vector<PageFile>& study_page_files();

}  // namespace gaussdrift::study

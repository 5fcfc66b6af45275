// The pictures of [Sch06] again: what its figures show, computed and drawn.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace gaussdrift::reproduce {

struct FiguresOptions {
  std::string figure;            // one of figure_numbers(), or empty for all
  std::filesystem::path folder;  // for the pictures
  bool full = false;             // 5.3 with the thesis's step of 0.001, 4.2 with its largest rows
  int threads = 0;               // 0: all; one where seconds are drawn, as the thesis's machine had one
};

struct Figure {
  std::string number;          // "5.1a"
  std::string caption;         // what it shows, and how it differs from the printed one
  std::filesystem::path file;  // written
  double seconds = 0;          // to compute and draw
};

/// "2.1", "3.1", "3.2", "3.3", ...
std::vector<std::string> figure_numbers();

/// Writes the pictures; `progress` is told the number that is being made. Throws CommandLineError for a number that
/// there is not, and where this program draws no pictures, FileError where a picture cannot be written.
std::vector<Figure> reproduce_figures(const FiguresOptions& options,
                                      const std::function<void(const std::string&)>& progress = {});

std::string to_text(const std::vector<Figure>& figures);
std::string to_json(const std::vector<Figure>& figures);

}  // namespace gaussdrift::reproduce

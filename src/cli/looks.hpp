// Options of verbs that draw: how pictures look.
#pragma once

#include <string>

#include "cli/options.hpp"
#include "gaussdrift/pictures.hpp"

namespace gaussdrift::cli {

/// As they were typed.
struct LookOptions {
  std::string range{}, size{}, view{}, zoom{}, colour_map{}, velocity{};
  bool log = false, per_frame = false, transparent = false, large_type = false;
};

void declare_looks(OptionList& options, LookOptions& given);

/// Throws CommandLineError where one is wrong.
PicturesSpec looks_of(const LookOptions& given);

/// "640x480". Throws CommandLineError.
std::array<int, 2> size_of(const std::string& option, const std::string& text);

/// A name of a list. Throws CommandLineError with the nearest one.
void check_name(const std::string& option, const std::string& name, const std::vector<std::string>& known);

}  // namespace gaussdrift::cli

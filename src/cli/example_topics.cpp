#include "cli/example_topics.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string_view>

#include "base/printable.hpp"
#include "gaussdrift/error.hpp"

namespace gaussdrift::cli {
namespace {

namespace fs = std::filesystem;

bool is_case(const input::ExampleFile& file) { return fs::path(file.name).extension() == ".toml"; }

std::string name_of(const input::ExampleFile& file) { return fs::path(file.name).stem().string(); }

/// What stands between the two, after the first `begin`. The text is not read as a case: it may need a file that is not there.
std::string between(std::string_view text, std::string_view begin, char end) {
  const std::size_t at = text.find(begin);
  if (at == std::string_view::npos) return "";
  const std::size_t first = at + begin.size(), last = text.find(end, first);
  return std::string(text.substr(first, last == std::string_view::npos ? last : last - first));
}

std::string title_of(std::string_view text) {
  const std::size_t at = text.find("\ntitle");
  return at == std::string_view::npos ? "" : between(text.substr(at), "\"", '"');
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// From what is simplest to what needs more; a topic that is not here comes last.
constexpr std::string_view order[] = {"flows in the plane",
                                      "flows in space",
                                      "velocities from data",
                                      "edges, land and the sphere",
                                      "sources",
                                      "diffusion and random walks",
                                      "reactions and tracers",
                                      "charges and vortices"};

bool comes_before(const Example& a, const Example& b) {
  const auto rank = [](const Example& example) { return std::find(std::begin(order), std::end(order), example.topic); };
  return rank(a) != rank(b) ? rank(a) < rank(b) : a.topic < b.topic;
}

}  // namespace

std::vector<Example> examples() {
  std::vector<Example> all;
  for (const input::ExampleFile& file : input::example_files())
    if (is_case(file)) all.push_back({name_of(file), title_of(file.bytes), between(file.bytes, "\n# Shows: ", '\n')});
  return all;
}

std::vector<Example> examples_about(const std::string& word) {
  std::vector<Example> found;
  std::vector<std::string> topics;
  std::vector<Example> all = examples();
  std::stable_sort(all.begin(), all.end(), comes_before);
  for (const Example& example : all) {
    if (lower(example.name + "\n" + example.title + "\n" + example.topic).find(lower(word)) != std::string::npos)
      found.push_back(example);
    if (std::find(topics.begin(), topics.end(), example.topic) == topics.end()) topics.push_back(example.topic);
  }
  if (found.empty())
    throw CommandLineError(
        fmt::format("no built-in case is about {}; they show {}", base::in_quotes(word, 60), fmt::join(topics, "; ")));
  return found;
}

std::vector<const input::ExampleFile*> files_of(const std::string& name) {
  std::vector<const input::ExampleFile*> files;
  for (const input::ExampleFile& file : input::example_files()) {
    const std::string stem = name_of(file);
    const bool numbered = stem.size() > name.size() + 1 && stem.compare(0, name.size() + 1, name + "_") == 0 &&
                          stem.find_first_not_of("0123456789", name.size() + 1) == std::string::npos;
    if (stem == name || numbered) files.push_back(&file);
  }
  return files;
}

}  // namespace gaussdrift::cli

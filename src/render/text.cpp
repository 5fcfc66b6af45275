#include "render/text.hpp"

#include <cstddef>
#include <map>
#include <mutex>
#include <tuple>

#include "render/drawing_library.hpp"

namespace gaussdrift::render {

namespace {

/// One line of well-formed UTF-8, with plain minus signs where the font has no others.
std::string drawable(const std::string& text) {
  std::string clean;
  for (std::size_t i = 0; i < text.size();) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const std::size_t length = byte < 0x80                   ? 1
                               : byte >= 0xC2 && byte < 0xE0 ? 2
                               : byte >= 0xE0 && byte < 0xF0 ? 3
                               : byte >= 0xF0 && byte < 0xF5 ? 4
                                                             : 0;
    bool whole = length > 0 && i + length <= text.size();
    for (std::size_t k = 1; whole && k < length; ++k) whole = (static_cast<unsigned char>(text[i + k]) & 0xC0) == 0x80;
    if (!whole) {
      clean += '?';
      ++i;
      continue;
    }
    const std::string letter = text.substr(i, length);
    clean += byte < 0x20 || byte == 0x7F ? " " : letter == "\u2212" && !drawing().has_font() ? "-" : letter;
    i += length;
  }
  return clean;
}

/// What was drawn already; all of it is forgotten once it is much. drawing_mutex() is held.
template <class Key, class Thing>
class Kept {
 public:
  template <class Make>
  const Thing& get(const Key& key, const Make& make) {
    constexpr std::size_t most = 2000;
    if (const auto found = things_.find(key); found != things_.end()) return found->second;
    Thing thing = make();
    if (things_.size() >= most) things_.clear();
    return things_.emplace(key, std::move(thing)).first->second;
  }

 private:
  std::map<Key, Thing> things_;
};

}  // namespace

std::shared_ptr<const Mask> text_mask(const std::string& text, const TextStyle& style) {
  using Key = std::tuple<std::string, int, Across, Along, bool>;
  const std::lock_guard lock(drawing_mutex());
  static auto* const masks = new Kept<Key, std::shared_ptr<const Mask>>;  // as long as the drawing library
  return masks->get({text, style.size, style.across, style.along, style.upwards}, [&] {
    const std::string clean = drawable(text);
    const bool is_blank = clean.find_first_not_of(' ') == std::string::npos;
    return std::make_shared<const Mask>(is_blank ? Mask{} : drawing().text(clean, style));
  });
}

double width_of_text(const std::string& text, int size) {
  const std::lock_guard lock(drawing_mutex());
  static auto* const widths = new Kept<std::pair<std::string, int>, double>;
  return widths->get({text, size}, [&] { return drawing().text_width(drawable(text), size); });
}

}  // namespace gaussdrift::render

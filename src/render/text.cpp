#include "render/text.hpp"

#include <map>
#include <mutex>
#include <tuple>

#include "render/drawing_library.hpp"
#include "render/letters.hpp"

namespace gaussdrift::render {

namespace {

/// One line of well-formed UTF-8, with plain minus signs where the font has no others.
std::string drawable(const std::string& text) {
  std::string clean;
  for (const char32_t code : code_points(text)) clean += code == U'\u2212' && !drawing().has_font() ? "-" : utf8(code);
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

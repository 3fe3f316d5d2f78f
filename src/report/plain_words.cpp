// SPDX-License-Identifier: BSL-1.0
#include "plain_words.hpp"

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace nysalt {

namespace {

/// http, https, or a place beside the page or in it: a report names no other scheme (javascript: runs).
bool is_plain_address(std::string_view address) {
  const auto colon = address.find(':');
  const bool relative = colon == std::string_view::npos || address.find('/') < colon;
  return relative || address.starts_with("http://") || address.starts_with("https://");
}

/// The text behind the opening mark at `at`, and where it goes on; nowhere if nothing closes it.
std::pair<styled_words, std::size_t> marked_words(std::string_view text, std::size_t at) {
  constexpr auto nowhere = std::string_view::npos;
  const auto enclosed = [&](std::string_view mark,
                            styled_words::kind kind) -> std::pair<styled_words, std::size_t> {
    const std::size_t from = at + mark.size();
    const std::size_t end = text.substr(at).starts_with(mark) ? text.find(mark, from) : nowhere;
    if (end == nowhere || end == from) return {{}, nowhere};
    return {{kind, std::string(text.substr(from, end - from))}, end + mark.size()};
  };
  if (text[at] == '`') return enclosed("`", styled_words::kind::code);
  if (text[at] == '*') return enclosed("**", styled_words::kind::bold);
  const std::size_t middle = text.find("](", at);
  const std::size_t end = middle == nowhere ? nowhere : text.find(')', middle);
  if (end == nowhere) return {{}, nowhere};
  const std::string_view address = text.substr(middle + 2, end - middle - 2);
  if (!is_plain_address(address)) return {{}, nowhere};
  return {{styled_words::kind::link, std::string(text.substr(at + 1, middle - at - 1)), std::string(address)},
          end + 1};
}

}  // namespace

std::vector<styled_words> plain_words(std::string_view text) {
  std::vector<styled_words> result;
  std::string plain;
  const auto flush = [&] {
    if (!plain.empty()) result.push_back({styled_words::kind::plain, std::exchange(plain, {})});
  };
  for (std::size_t at = 0; at < text.size();) {
    if (text[at] == '`' || text[at] == '*' || text[at] == '[') {
      auto [marked, next] = marked_words(text, at);
      if (next != std::string_view::npos) {
        flush();
        result.push_back(std::move(marked));
        at = next;
        continue;
      }
    }
    plain += text[at++];
  }
  flush();
  return result;
}

}  // namespace nysalt

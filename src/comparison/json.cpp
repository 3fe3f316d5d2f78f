// SPDX-License-Identifier: BSL-1.0
#include "json.hpp"

namespace nysalt::program {

std::string text_of(const json& document) {
  return document.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
}

json as_kept(const json& document) {
  return json::parse(document.dump(-1, ' ', false, json::error_handler_t::replace));
}

}  // namespace nysalt::program

// SPDX-License-Identifier: BSL-1.0
// Where integrators come to grief, and what must hold there all the same.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "../../../src/report/figure.hpp"

namespace nysalt::hard {

/// A test takes a second, the page some minutes.
enum class extent { quick, full };

struct captioned_panels {
  std::vector<panel> panels;
  std::string caption;
  int width;  // in pixels
};

/// What was measured, in sentences, and whether it is as it must be.
class verdict {
 public:
  /// What must be.
  void require(bool so, std::string measured) {
    holds_ = holds_ && so;
    measured_.push_back((so ? "" : "**not so:** ") + std::move(measured));
  }
  /// What is worth knowing.
  void note(std::string measured) { measured_.push_back(std::move(measured)); }
  /// Once at most: the picture has the name of the case.
  void show(std::vector<panel> panels, std::string caption, int width = figure().width) {
    picture_ = {std::move(panels), std::move(caption), width};
  }

  bool holds() const { return holds_; }
  const std::vector<std::string>& measured() const { return measured_; }
  const std::optional<captioned_panels>& picture() const { return picture_; }

 private:
  bool holds_ = true;
  std::vector<std::string> measured_;
  std::optional<captioned_panels> picture_;
};

struct hard_case {
  std::string name;  // in words with _ between them; also that of its picture
  std::string what;
  std::string must_hold;
  std::string must_fail;  // beside it: what the same judgement must reject
  std::function<verdict(extent)> run;
};

struct topic {
  std::string title;
  std::vector<hard_case> cases;
};

// One file each.
topic stability();
topic stiffness();
topic several_forces();
topic orbits();
topic collisions();
topic rough_potentials();
topic baths();
topic long_runs();
topic magnitudes();

std::vector<topic> all_topics();

}  // namespace nysalt::hard

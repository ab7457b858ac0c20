// Time per stage. A stage that never ran has no row.
#pragma once

#include <chrono>
#include <cstdint>
#include <iosfwd>
#include <string>
#include <vector>

namespace dovetail {

/// Wall-clock seconds by named stage. When disabled, a Stage costs one branch.
class Profile {
public:
  struct Row {
    std::string name;
    double seconds = 0.0;
    std::int64_t calls = 0;
  };

  explicit Profile(bool enabled = false) : enabled_(enabled) {}
  bool enabled() const { return enabled_; }
  const std::vector<Row>& rows() const { return rows_; }
  void add(const char* name, double seconds);

  /// Times its own lifetime under `name` (a string literal).
  class Stage {
  public:
    Stage(Profile& profile, const char* name) : profile_(profile.enabled_ ? &profile : nullptr), name_(name) {
      if (profile_) start_ = std::chrono::steady_clock::now();
    }
    ~Stage() {
      if (profile_)
        profile_->add(name_, std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count());
    }
    Stage(const Stage&) = delete;
    Stage& operator=(const Stage&) = delete;

  private:
    Profile* profile_;
    const char* name_;
    std::chrono::steady_clock::time_point start_;
  };

private:
  bool enabled_;
  std::vector<Row> rows_;
};

/// A table, a row per stage; nothing at all if no stage ran.
std::ostream& operator<<(std::ostream& out, const Profile& profile);

}  // namespace dovetail

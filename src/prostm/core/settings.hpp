#pragma once
/// How a stage's settings are listed once, and read, written and documented from that one list.
///
/// Each `XxxSettings` has `void visit(SettingsVisitor&)`, which names its fields in order. Names in
/// files are the names in C++, values are SI as in C++. `io` reads TOML and writes JSON through
/// this interface alone.

#include <string>

namespace prostm {

class SettingsVisitor {
 public:
  virtual ~SettingsVisitor() = default;
  virtual void field(const char* name, double& value) = 0;
  virtual void field(const char* name, int& value) = 0;
  virtual void field(const char* name, bool& value) = 0;
  virtual void field(const char* name, std::string& value) = 0;
};

}  // namespace prostm

#pragma once
/// Results of the stand-in's calls: a value, or an error with a message.

#include <optional>
#include <string>
#include <utility>

namespace Ultraleap::Haptics {

class Error {
 public:
  explicit Error(std::string message) : message_(std::move(message)) {}
  const std::string& message() const { return message_; }

 private:
  std::string message_;
};

struct Unexpected {
  Error error;
};

template <class T>
class [[nodiscard]] result {
 public:
  result(T value) : value_(std::move(value)) {}
  result(Unexpected failed) : error_(std::move(failed.error)) {}
  explicit operator bool() const { return value_.has_value(); }
  bool has_value() const { return value_.has_value(); }
  T& value() { return value_.value(); }
  const T& value() const { return value_.value(); }
  const Error& error() const { return error_.value(); }

 private:
  std::optional<T> value_;
  std::optional<Error> error_;
};

template <>
class [[nodiscard]] result<void> {
 public:
  result() = default;
  result(Unexpected failed) : error_(std::move(failed.error)) {}
  explicit operator bool() const { return !error_.has_value(); }
  bool has_value() const { return !error_.has_value(); }
  const Error& error() const { return error_.value(); }

 private:
  std::optional<Error> error_;
};

}  // namespace Ultraleap::Haptics

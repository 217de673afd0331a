#pragma once

#include <stdexcept>
#include <string>

namespace vmesh {

/// Base of everything vmesh throws. The message names file, line or element, what is wrong, and what to do.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The content of a file or an argument is wrong (NaN, zero radius, broken XML, unknown node ...).
class InvalidInput : public Error {
 public:
  using Error::Error;
};

/// A file cannot be opened or read.
class ReadError : public Error {
 public:
  using Error::Error;
};

/// A file cannot be written; nothing is left behind under its final name.
class WriteError : public Error {
 public:
  using Error::Error;
};

/// The request is sensible, but this build or this version cannot serve it.
class Unsupported : public Error {
 public:
  using Error::Error;
};

/// The progress callback asked to stop.
class Cancelled : public Error {
 public:
  Cancelled() : Error("cancelled") {}
};

}  // namespace vmesh

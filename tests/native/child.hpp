// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <functional>
#include <string>
#include <vector>

#include "platform/error.hpp"
#include "platform/file_descriptor.hpp"

/// Bidirectional lines of text between a test and a process that it started.
class Lines {
public:
  Lines(manycore::FileDescriptor in, manycore::FileDescriptor out);
  void say(const std::string & line);
  /// Returns the next line. Throws if none arrives within `timeout_s`, or if the other side has
  /// ended.
  std::string hear();
  /// Throws unless the next line is `expected`.
  void expect(const std::string & expected);
  /// True if a line or the end of the stream is available within `timeout_ms`.
  bool has_news(int timeout_ms = 0) const;

private:
  manycore::FileDescriptor in_;
  manycore::FileDescriptor out_;
  std::string unread_;
};

using Arguments = std::vector<std::string>;

/// Behaviour of a process started by a test. Defined at file scope:
///   const Role silent_publisher("silent_publisher", [](Lines & test, const Arguments & arguments)
///   {...});
class Role {
public:
  using Play = std::function<void(Lines & test, const Arguments & arguments)>;
  Role(const char * name, Play play);

  /// Plays the role that this program was started for; false if it was started to run its tests.
  static bool play(int argc, char ** argv, int & status);
};

/// For a role, which is no test case: throws the text of errno, which the test receives.
inline void require(bool done) {
  if (!done) {
    manycore::throw_errno("the role failed");
  }
}

/// A process in one of this program's roles: a real process that can be stopped and killed.
class Child {
public:
  explicit Child(const std::string & role, const Arguments & arguments = {});
  Child(Child && other) noexcept;
  /// Kills the process if it still lives.
  ~Child();

  pid_t pid() const noexcept { return pid_; }
  Lines & lines() noexcept { return lines_; }
  void say(const std::string & line) { lines_.say(line); }
  std::string hear() { return lines_.hear(); }
  void expect(const std::string & line) { lines_.expect(line); }

  void stop();  ///< SIGSTOP; returns once it is stopped
  /// For a process that stops itself: a SIGCONT before that would be lost.
  void wait_until_stopped();
  void resume();  ///< SIGCONT
  void kill();    ///< SIGKILL; returns once it has ended
  /// Waits for the end; returns the exit status, or minus the terminating signal. Throws if the
  /// process lives longer than `timeout_s`.
  int wait();

private:
  Child(pid_t pid, Lines lines) : pid_(pid), lines_(std::move(lines)) {}
  static Child start(const std::string & role, const Arguments & arguments);

  pid_t pid_;
  Lines lines_;
};

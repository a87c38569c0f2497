// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/waiting/waiters.hpp"

#include "transport/waiting/thread_number.hpp"

namespace manycore {

static_assert(first_thread_word + thread_numbers == wake_words_per_process);

Waiters::Waiters(GraphWatchers & graph_watchers, uint32_t process, WakeWords & words, WaitMode mode)
: graph_watchers_(graph_watchers), process_(process), words_(words) {
  for (uint32_t number = 0; number < wake_words_per_process; ++number) {
    waiters_.emplace_back(words.words[number], mode, process, number);
  }
}

uint32_t Waiters::word_of_this_thread() noexcept { return first_thread_word + thread_number(); }

/// No wake-up is lost: both are added, seq_cst, before the thread looks at the graph. A notifier
/// changes the graph before it reads either, so at least one of them sees the other. The process
/// stays a watcher, as another of its threads may wait.
void Waiters::watch_graph(uint32_t word) noexcept {
  graph_watchers_.add(process_);
  words_.graph.add(word);
}

void Waiters::notify(const Watchers & watchers) noexcept {
  watchers.read().for_each([this](uint32_t word) { waiters_[word].notify(); });
}

void Waiters::notify_all() noexcept {
  for (Waiter & waiter : waiters_) {
    waiter.notify();
  }
}

/// A shared word stays: one thread may wait on it while another was woken for nothing. No thread
/// can begin to share a unique one while it is removed.
void Waiters::forget_this_thread() noexcept {
  if (is_shared_number(thread_number())) {
    return;
  }
  const uint32_t word = word_of_this_thread();
  words_.graph.remove(word);
  words_.endpoint_events.remove(word);
  const std::lock_guard<std::mutex> lock(mutex_);
  for (Watchers * const watchers : watched_) {
    watchers->remove(word);
  }
}

Watched::Watched(Waiters & waiters, Watchers & watchers) : waiters_(waiters), watchers_(watchers) {
  const std::lock_guard<std::mutex> lock(waiters_.mutex_);
  waiters_.watched_.insert(&watchers_);
}

Watched::~Watched() {
  if (waiters_.side_.is_inherited()) {
    return;
  }
  const std::lock_guard<std::mutex> lock(waiters_.mutex_);
  waiters_.watched_.erase(&watchers_);
}

}  // namespace manycore

/* Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
 *
 * Question: does a RELIABLE + KEEP_ALL publisher that waits for room wake when its reader has taken
 * the record, or is closed?
 *
 * Follows TopicDsmWriter::wait_for_progress, notify_waiting_publisher(), Source::release and
 * closing.cpp (undo_match). The time limit of the wait is omitted: a publisher that needs it shows
 * as an invalid end state.
 *
 * BUG 1: no fence between taken and the load of writer_waits
 * BUG 2: no fence between writer_waits and the load of taken
 * BUG 3: progress loaded after taken
 * BUG 4: a closed reader's publisher is woken before the source is revoked
 * BUG 5: publisher does not load taken again after it set writer_waits
 * BUG 6: woken without incrementing progress
 * BUG 7: no fence between the source's state and the load of writer_waits
 */
#define TAKEN 0
#define PROGRESS 1
#define WRITER_WAITS 2
#define REVOKED 3         /* state of the source */
#define WORDS 4
#define PROCESSES 3
#define PUBLISHER 0
#define READER 1
#define CLOSER 2
#define MESSAGES 2

#include "tso.pml"

bool asleep;
bool closing;

inline notify_waiting_publisher(p) {
  if
  :: load(p, WRITER_WAITS) != 0 ->
#if BUG != 6
     d_step { settled(p) -> memory[PROGRESS]++ };
#endif
     asleep = false
  :: else
  fi
}

/* The kernel compares and queues atomically. */
inline futex_wait() {
  atomic {
    if
    :: load(PUBLISHER, PROGRESS) == seen -> asleep = true
    :: else
    fi
  };
  !asleep
}

#define is_owed(n) (load(PUBLISHER, TAKEN) < (n) && !load(PUBLISHER, REVOKED))

inline wait_for_progress(n) {
#if BUG != 3
  seen = load(PUBLISHER, PROGRESS);
#endif
#if BUG == 2
  store_release(PUBLISHER, WRITER_WAITS, 1);
#else
  store_seq_cst(PUBLISHER, WRITER_WAITS, 1);
#endif
  if
  :: BUG == 5 || is_owed(n) ->
#if BUG == 3
     seen = load(PUBLISHER, PROGRESS);
#endif
     futex_wait()
  :: BUG != 5 && !is_owed(n)
  fi;
  store_release(PUBLISHER, WRITER_WAITS, 0)
}

proctype Publisher() {
  byte n = 1, seen;
  do
  :: n <= MESSAGES && is_owed(n) -> wait_for_progress(n)
  :: n <= MESSAGES && !is_owed(n) -> n++
  :: n > MESSAGES -> break
  od
}

proctype Reader() {
  byte n;
  {
    do
    :: n < MESSAGES ->
       n++;
#if BUG == 1
       store_release(READER, TAKEN, n);
#else
       store_seq_cst(READER, TAKEN, n);
#endif
       notify_waiting_publisher(READER)
    :: n == MESSAGES -> break
    od
  } unless { closing }
}

/* Closes or reaps the reader at any step, or never. */
proctype Closer() {
  if
  :: closing = true;
#if BUG == 4
     notify_waiting_publisher(CLOSER);
     store_seq_cst(CLOSER, REVOKED, 1)
#elif BUG == 7
     store_release(CLOSER, REVOKED, 1);
     notify_waiting_publisher(CLOSER)
#else
     store_seq_cst(CLOSER, REVOKED, 1);
     notify_waiting_publisher(CLOSER)
#endif
  :: skip
  fi
}

init {
  atomic {
    run StoreBuffer(PUBLISHER); run StoreBuffer(READER); run StoreBuffer(CLOSER);
    run Publisher(); run Reader(); run Closer()
  }
}

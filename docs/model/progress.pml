/* Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
 *
 * Question: does a RELIABLE + KEEP_ALL publisher that waits for room wake when its reader has taken
 * the record, or is closed, although closing a reader is a change of its row and no more?
 *
 * The process that closes a reliable reader, or its reaper, raises `changes` and then looks at the
 * publishers of the topic: those that wait are woken, look at `changes`, and find the reader gone. The
 * time limit of the wait is omitted: a publisher that needs it shows as an invalid end state.
 *
 * BUG 1: no fence between taken and the load of writer_waits
 * BUG 2: no fence between writer_waits and the loads of changes and taken
 * BUG 3: progress loaded after taken
 * BUG 4: a waiting publisher is looked for before the row is closed
 * BUG 5: publisher looks for neither changes nor taken after it set writer_waits
 * BUG 6: woken without incrementing progress
 * BUG 7: publisher loads changes before it sets writer_waits
 * BUG 8: a closed reader's publishers are not looked at
 * BUG 9: changes raised before the row is closed
 */
#define TAKEN 0           /* of the seat */
#define PROGRESS 1
#define WRITER_WAITS 2
#define LIVE 3            /* row of the reader */
#define CHANGES 4
#define WORDS 5
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

inline refresh() {
  now = load(PUBLISHER, CHANGES);
  if
  :: now != seen_changes -> is_reader = load(PUBLISHER, LIVE); seen_changes = now
  :: else
  fi
}

#define is_owed(n) (is_reader && load(PUBLISHER, TAKEN) < (n))

inline wait_for_progress(n) {
#if BUG != 3
  seen = load(PUBLISHER, PROGRESS);
#endif
#if BUG == 7
  refresh();
#endif
#if BUG == 2
  store_release(PUBLISHER, WRITER_WAITS, 1);
#else
  store_seq_cst(PUBLISHER, WRITER_WAITS, 1);
#endif
#if BUG != 5 && BUG != 7
  refresh();
#endif
  if
  :: BUG == 5 || is_owed(n) ->
#if BUG == 3
     seen = load(PUBLISHER, PROGRESS);
#endif
     futex_wait()
  :: BUG != 5 && !is_owed(n)
  fi;
  store_release(PUBLISHER, WRITER_WAITS, 0);
  refresh()                /* enters its phase again */
}

proctype Publisher() {
  byte n = 1, seen, now, seen_changes;
  bool is_reader = true;
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

inline raise() {
  d_step { settled(CLOSER) -> memory[CHANGES]++ }
}

/* Closes or reaps the reader at any step, or never. */
proctype Closer() {
  if
  :: closing = true;
#if BUG == 4
     notify_waiting_publisher(CLOSER);
#endif
#if BUG == 9
     raise();
     store_release(CLOSER, LIVE, 0);
#else
     store_release(CLOSER, LIVE, 0);
     raise();
#endif
#if BUG != 4 && BUG != 8
     notify_waiting_publisher(CLOSER)
#endif
  :: skip
  fi
}

init {
  atomic {
    memory[LIVE] = 1;
    run StoreBuffer(PUBLISHER); run StoreBuffer(READER); run StoreBuffer(CLOSER);
    run Publisher(); run Reader(); run Closer()
  }
}

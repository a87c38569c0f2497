/* Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
 *
 * Question: is the memory of an old generation freed only when no reader accesses it, nor what is
 * later placed in the same memory and entry?
 *
 * Follows TopicDsmWriter (add_generation, retire, free_old_generations), Source (claim,
 * generation_of, scan) and the publisher's ReaderList::refresh. Each generation has its own entry
 * and memory, and one record, whose number names the generation. Any reader may look for any
 * published number; no reader wants the records of old generations any more, so the publisher
 * closes them in any order. It waits here for a pinned generation instead of retrying at its next
 * message. Reading freed memory would allocate a page for it again, or end the reader if /dev/shm
 * is full. A reader may stop for ever while it looks at the header only: that keeps no generation,
 * so the publisher comes to its end.
 *
 * BUG 1: first cleared after the load of reading
 * BUG 2: no fence between first and the load of reading (publisher)
 * BUG 3: no fence between reading and the load of first (reader)
 * BUG 4: publisher checks for claims on the generation's own records only
 * BUG 5: a look at the header keeps all generations
 * BUG 6: reader list refreshed before first is cleared, not after
 * BUG 7: freed before the load of reading
 * BUG 8: reader does not check again the entry that it chose
 * BUG 9: a scan does not check again the generation that it pins
 * BUG 10: no fence between reading and the second load of first (scan)
 * BUG 11: a scan pins the header only
 */
#define FIRST(e) (e)      /* of the generation entries */
#define READING 3
#define LAST 4
#define CHANGES 5      /* changes of the topic's bucket */
#define WORDS 6
#define PROCESSES 2
#define PUBLISHER 0
#define READER 1
#define ENTRIES 3

#define unused 0
#define no_record 0
#define header_only 255

#include "tso.pml"

byte holds[ENTRIES];      /* generation held by the memory of an entry; 0 = freed */

/* Any access to descriptors or bytes of the generation found in entry e. */
inline touch(e, generation) {
  assert(holds[e] == generation)
}

/* Source */

inline look_at(e) {
  atomic {
    seen = load(READER, FIRST(e));
    if
    :: seen != unused && seen <= n && seen > best -> best = seen; entry = e
    :: else
    fi;
    seen = 0
  }
}

inline claim() {
#if BUG == 3
  store_release(READER, READING, n);
#else
  store_seq_cst(READER, READING, n);
#endif
  look_at(0);
  look_at(1);
  look_at(2);
#if BUG != 8
  atomic {
    if
    :: best != unused && load(READER, FIRST(entry)) != best -> best = unused   /* gone */
    :: else
    fi
  };
#endif
  if
  :: best != unused -> touch(entry, best); touch(entry, best)
  :: else
  fi;
  store_release(READER, READING, no_record);
  best = 0;
  entry = 0
}

inline scan_generation(e) {
  best = load(READER, FIRST(e));
  if
  :: best != unused ->
#if BUG == 10
     store_release(READER, READING, best);
#elif BUG == 11
     store_seq_cst(READER, READING, header_only);
#else
     store_seq_cst(READER, READING, best);
#endif
     if
#if BUG == 9
     :: true ->
#else
     :: load(READER, FIRST(e)) == best ->
#endif
        touch(e, best);
        touch(e, best)
     :: else
     fi
  :: else
  fi;
  best = 0
}

inline look_at_header() {
  store_seq_cst(READER, READING, header_only)
}

inline scan() {
  look_at_header();
  scan_generation(0);
  scan_generation(1);
  scan_generation(2);
  store_release(READER, READING, no_record)
}

/* Joins at any time; it may look once its row is live and changes are raised. */
proctype Reader() {
  byte n, seen, best, entry, claims;
  d_step { settled(READER) -> memory[CHANGES] = 1 };
  do
  :: claims < 2 ->
     claims++;
     n = 1;
     do
     :: n < load(READER, LAST) -> n++
     :: break
     od;
     claim();
     n = 0
  :: claims < 2 -> claims++; scan()
  :: look_at_header(); break   /* and stops there */
  :: break
  od
}

/* TopicDsmWriter */

inline refresh() {
  knows_reader = load(PUBLISHER, CHANGES) != 0
}

inline open(e, n) {
  holds[e] = n;
  store_release(PUBLISHER, FIRST(e), n);
  store_seq_cst(PUBLISHER, LAST, n)
}

#if BUG == 4
#define is_in(r, n, current) ((r) == (n))
#else
#define is_in(r, n, current) ((r) >= (n) && (r) < (current))
#endif
#if BUG == 5
#define pins_all(r) ((r) == header_only)
#else
#define pins_all(r) false
#endif
#define is_pinned(n, current) \
  (knows_reader && \
   (is_in(load(PUBLISHER, READING), n, current) || pins_all(load(PUBLISHER, READING))))

inline retire(e, n, current) {
#if BUG == 1
  refresh();
  !is_pinned(n, current);
#endif
#if BUG == 6
  refresh();
#endif
#if BUG == 2
  store_release(PUBLISHER, FIRST(e), unused);
#else
  store_seq_cst(PUBLISHER, FIRST(e), unused);
#endif
#if BUG != 6
  refresh();
#endif
#if BUG != 1 && BUG != 7
  !is_pinned(n, current);
#endif
  holds[e] = unused
}

proctype Publisher() {
  bool knows_reader;
  open(1, 2);
  open(2, 3);
  if
  :: retire(0, 1, 3); retire(1, 2, 3); open(0, 4); retire(2, 3, 4)
  :: retire(1, 2, 3); open(1, 4); retire(0, 1, 4); retire(2, 3, 4)
  fi
}

init {
  atomic {
    memory[FIRST(0)] = 1;
    memory[LAST] = 1;
    holds[0] = 1;
    run StoreBuffer(PUBLISHER); run StoreBuffer(READER);
    run Publisher(); run Reader()
  }
}

/* Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
 *
 * Question: do the bytes of a record stay while a reader holds them, does only one that is alone
 * with them write into them, and does the publisher get each chunk back in the end?
 *
 * Follows TopicDsmWriter (state_of, find_chunk_room, commit) and Claim::hold(). A record lies in a
 * chunk of its own. Its publisher overwrites at any time: nothing is owed. Reader 0 is there from
 * the beginning, and may leave while it holds, or be killed at any step and be reaped. Reader 1 comes
 * at any time. Each has a word in each chunk; that a chunk has room for a further word is left out.
 *
 * RUN KILLABLE=0
 * RUN KILLABLE=1 (long)
 * BUG 1: hold stored after the end of the claim
 * BUG 2: publisher looks for holds before it looks for claims
 * BUG 3: the mark for one reader is stored before the list of readers is renewed
 * BUG 4: a reader is alone although one that has left still holds the record
 * BUG 5: hold given back before the last access
 * BUG 6: holds of readers that have left do not count
 * BUG 7 KILLABLE=1 (long): holds of a reader that was killed count for ever
 * BUG 8: number cleared after the looks
 */
#define COUNT 2           /* descriptors */
#define CHUNKS 3          /* each of two readers keeps one at a time */
#define MESSAGES 3
#define NUMBER(d) (d)
#define CHUNK(d) (2 + (d))
#define ALONE(d) (4 + (d))       /* RecordMemory::chunk_of_one_reader */
#define DATA(c) (6 + (c))
#define HOLDER(c, r) (9 + 2 * (c) + (r))
#define READING(r) (15 + (r))
#define LAST 17
#define CHANGES 18
#define LIVE(r) (19 + (r))
#define WORDS 21
#define PROCESSES 3
#define PUBLISHER 2       /* readers are processes 0 and 1 */

#define no_record 0
#define scribble 100

#include "tso.pml"

byte starts[2] = 255;     /* of the seat that the publisher has given; 255: none */
bool killed, dead, reaped;
byte gone;

/* Reader */

#if BUG == 4
#define is_alone(c, r) true
#else
#define is_alone(c, r) (load(r, HOLDER(c, 1 - (r))) == 0)
#endif

inline change_row(live) {
  atomic { settled(r) -> memory[LIVE(r)] = live; memory[CHANGES]++ }
}

inline access() {
  d_step {
    assert(load(r, DATA(c)) == (is_sole -> scribble + n : n))
  }
}

inline take_hold() {
  atomic { settled(r) -> memory[HOLDER(c, r)] = 1 }
}

inline give_back() { store_seq_cst(r, HOLDER(c, r), 0) }

inline keep() {
#if BUG == 1
  store_release(r, READING(r), no_record);
  take_hold();
#else
  take_hold();
#endif
  d_step {
    is_sole = load(r, ALONE(n % COUNT)) == n && is_alone(c, r)
  };
#if BUG != 1
  store_release(r, READING(r), no_record);
#endif
  if
  :: r == 0 && !has_left -> has_left = true; change_row(0)
  :: true
  fi;
  if
  :: is_sole -> store_release(r, DATA(c), scribble + n)
  :: else
  fi;
  access();
#if BUG == 5
  give_back();
  access();
#else
  access();
  give_back();
#endif
  is_sole = false
}

proctype Reader(byte r; byte claims) {
  byte noted, n, c;
  bool is_sole, has_left;
  {
    if
    :: r == 1 -> change_row(1)
    :: else
    fi;
    do
    :: atomic {
         claims > 0 && !has_left && starts[r] != 255 &&
           load(r, LAST) > (noted > starts[r] -> noted : starts[r]) ->
         n = load(r, LAST)
       };
       store_seq_cst(r, READING(r), n);
       if
       :: load(r, NUMBER(n % COUNT)) == n ->
          c = load(r, CHUNK(n % COUNT));
          access();
          if
          :: true -> keep()
          :: true -> access(); store_release(r, READING(r), no_record)
          fi
       :: else -> store_release(r, READING(r), no_record)
       fi;
       atomic { noted = n; n = 0; c = 0; claims-- }
    :: true -> break
    od
  } unless { r == 0 && killed };
  if
  :: r == 0 && killed -> dead = true
  :: else -> gone++
  fi
}

/* SIGKILL at any step of reader 0, or never. The slot of the process is free once it is reaped. */
proctype Reaper() {
  if
  :: KILLABLE -> killed = true;
     if
     :: atomic { dead && settled(0) -> memory[LIVE(0)] = 0; memory[CHANGES]++; reaped = true; gone++ }
     :: gone == 2
     fi
  :: skip
  fi
}

/* Publisher */

inline refresh() {
  d_step {
    if
    :: load(PUBLISHER, CHANGES) != seen ->
       seen = load(PUBLISHER, CHANGES);
       is_listed[0] = load(PUBLISHER, LIVE(0)) == 1;
       is_listed[1] = load(PUBLISHER, LIVE(1)) == 1;
       if
       :: is_listed[1] && starts[1] == 255 -> starts[1] = last
       :: else
       fi
    :: else
    fi
  }
}

inline look_at_claims(n) {
  d_step {
    is_read = is_read || (is_listed[0] && load(PUBLISHER, READING(0)) == n) ||
              (is_listed[1] && load(PUBLISHER, READING(1)) == n)
  }
}

#if BUG == 6
#define counts_of(r) is_listed[r]
#elif BUG == 7
#define counts_of(r) true
#else
#define counts_of(r) (r == 1 || !reaped)
#endif

inline look_at_holds() {
  d_step {
    is_read = is_read || (counts_of(0) && load(PUBLISHER, HOLDER(i, 0)) == 1) ||
              (counts_of(1) && load(PUBLISHER, HOLDER(i, 1)) == 1)
  }
}

inline clear_number() {
  if
  :: load(PUBLISHER, NUMBER(record[i] % COUNT)) == record[i] ->
     store_seq_cst(PUBLISHER, NUMBER(record[i] % COUNT), no_record);
     refresh()
  :: else
  fi
}

/* state_of() of chunk i. */
inline look() {
  is_read = false;
#if BUG != 8
  clear_number();
#endif
#if BUG == 2
  look_at_holds();
  look_at_claims(record[i]);
#else
  look_at_claims(record[i]);
  look_at_holds();
#endif
#if BUG == 8
  clear_number();
#endif
}

inline find_chunk() {
  i = 0;
  do
  :: record[i] == no_record -> break
  :: else ->
     look();
     if
     :: !is_read -> record[i] = no_record; break
     :: else -> i++
     fi;
     assert(i < CHUNKS)          /* else the message is refused */
  od
}

inline mark() {
  if
  :: is_listed[0] + is_listed[1] == 1 ->
     store_release(PUBLISHER, ALONE(next % COUNT), next)
  :: else
  fi
}

/* The descriptor's former record may still be in its chunk, read or held. */
inline commit() {
  if
  :: load(PUBLISHER, NUMBER(next % COUNT)) != no_record ->
     store_seq_cst(PUBLISHER, NUMBER(next % COUNT), no_record);
     refresh()
  :: else
  fi;
  is_pinned = false;
  d_step {
    is_pinned = next > COUNT &&
      ((is_listed[0] && load(PUBLISHER, READING(0)) == next - COUNT) ||
       (is_listed[1] && load(PUBLISHER, READING(1)) == next - COUNT))
  };
  if
  :: is_pinned -> next++          /* the number is passed over */
  :: else ->
     store_release(PUBLISHER, DATA(i), next);
     store_release(PUBLISHER, CHUNK(next % COUNT), i);
#if BUG == 3
     mark();
#endif
     store_release(PUBLISHER, NUMBER(next % COUNT), next);
     store_seq_cst(PUBLISHER, LAST, next);
     refresh();
#if BUG != 3
     mark();
#endif
     d_step { record[i] = next; last = next; next++ }
  fi
}

proctype Publisher() {
  byte next = 1, last, seen, i;
  byte record[CHUNKS];
  bool is_listed[2], is_read, is_pinned;
  do
  :: next <= MESSAGES -> refresh(); find_chunk(); commit()
  :: else -> break
  od;
  /* In the end all chunks are free again. */
  atomic { gone == 2 && settled(0) && settled(1) };
  refresh();
  i = 0;
  do
  :: i < CHUNKS && record[i] != no_record -> look(); assert(!is_read); i++
  :: i < CHUNKS && record[i] == no_record -> i++
  :: else -> break
  od
}

init {
  atomic {
    memory[LIVE(0)] = 1;
    memory[CHANGES] = 1;
    starts[0] = 0;
    run StoreBuffer(0); run StoreBuffer(1); run StoreBuffer(PUBLISHER);
    run Reader(0, 1); run Reader(1, 1); run Reaper(); run Publisher()
  }
}

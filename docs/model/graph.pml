/* Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
 *
 * Question: does a reader of the graph, without the registry lock, find each entry consistent, and
 * all entries while nothing changes? Does it terminate although the owner of the lock is stopped?
 *
 * Follows Registry::Lock, Table::take, EntryCopy, and read_between_changes with two attempts.
 * Outside of changes, one of two slots is live. The writer replaces one by the other, twice, and is
 * killed at any step. An entry is consistent if both its fields belong to the same use.
 *
 * BUG 1: copy not compared with the slot afterwards
 * BUG 2: incarnation not incremented when the slot is reused
 * BUG 3: state loaded before the incarnation
 * BUG 4: changes not compared after the read
 * BUG 5: changes incremented only when the lock is released
 * BUG 6: slot live before it is filled in
 * BUG 7: an odd number of changes treated as no change in progress
 */
#define CHANGES 0
#define STATE(i) (1 + 4 * (i))
#define INCARNATION(i) (2 + 4 * (i))
#define FIRST(i) (3 + 4 * (i))
#define SECOND(i) (4 + 4 * (i))
#define WORDS 9
#define PROCESSES 2

#define READER 0
#define WRITER 1
#define FREE 0
#define LIVE 1
#define ATTEMPTS 2

#include "tso.pml"

byte changes;             /* stored by the writer only */
byte uses;
bool killed;

inline begin_change() {
  changes++;
#if BUG != 5
  store_release(WRITER, CHANGES, changes)
#else
  skip
#endif
}

inline end_change() {
  changes++;
  store_release(WRITER, CHANGES, changes)
}

inline fill(i) {
  uses++;
#if BUG != 2
  store_release(WRITER, INCARNATION(i), uses);
#endif
#if BUG == 6
  store_release(WRITER, STATE(i), LIVE);
#endif
  store_release(WRITER, FIRST(i), uses);
  store_release(WRITER, SECOND(i), uses);
  store_release(WRITER, STATE(i), LIVE)
}

inline replace(old, new) {
  begin_change();
  store_release(WRITER, STATE(old), FREE);
  fill(new);
  end_change()
}

proctype Writer() {
  { replace(0, 1); replace(1, 0) } unless { killed }
}

proctype Killer() {
  killed = true
}

inline look_at(i) {
#if BUG == 3
  state = load(READER, STATE(i));
  incarnation = load(READER, INCARNATION(i));
#else
  incarnation = load(READER, INCARNATION(i));
  state = load(READER, STATE(i));
#endif
  if
  :: state == LIVE ->
     first = load(READER, FIRST(i));
     second = load(READER, SECOND(i));
#if BUG != 1
     state = load(READER, STATE(i));
     if
     :: state == LIVE && load(READER, INCARNATION(i)) == incarnation ->
#endif
     assert(first == second);
     found++
#if BUG != 1
     :: else
     fi
#endif
  :: else
  fi
}

proctype Reader() {
  byte attempt, before, after, found, state, incarnation, first, second;
  do
  :: attempt < ATTEMPTS ->
     attempt++;
     found = 0;
     before = load(READER, CHANGES);
     look_at(0);
     look_at(1);
     after = load(READER, CHANGES);
#if BUG == 4
     after = before;
#endif
     if
     :: after == before && (before % 2 == 0 || BUG == 7) -> assert(found == 1); break
     :: else
     fi
  :: else -> break
  od
}

init {
  atomic {
    uses = 1;
    memory[STATE(0)] = LIVE;
    memory[INCARNATION(0)] = 1; memory[FIRST(0)] = 1; memory[SECOND(0)] = 1;
    run StoreBuffer(WRITER);
    run Writer();
    run Killer();
    run Reader()
  }
}

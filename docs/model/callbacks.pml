/* Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
 *
 * Question: is each message reported to its callback, though a publisher of the same context spares
 * the thread that calls callbacks, and never waits, and the thread looks only at what is marked?
 *
 * Follows Outbox::publish, WakeWords::mark_arrival, CallbackMarks, CallbackThread::spared, ::report
 * and ::run, and Callback::set, with two publishers, the thread, and one that sets the callback
 * meanwhile. A publisher with no callback in sight may as well be another process. What they share
 * is guarded by the mutex or changed by locked instructions, so store buffers are not modelled. A
 * callback may publish itself, and a subscription may need a look that would wait for another
 * thread.
 *
 * RUN MESSAGES=1
 * RUN MESSAGES=2 (long)
 *
 * BUG 1: a publisher that does not get the mutex leaves it at that
 * BUG 2: the thread reads the epoch after it has looked
 * BUG 3: the word is spared though no callback was in sight
 * BUG 4: a message that a callback publishes is not left to the thread
 * BUG 5: a look that would wait is not left to the thread
 * BUG 6: watchers added after the thread has looked
 * BUG 7: the epoch raised before the mark
 * BUG 8: the thread takes the marks before it reads the epoch
 * BUG 9: what a publisher leaves to the thread is not marked
 * BUG 10: a callback that is set anew is not looked at until it is marked
 */
#define PUBLISHERS 2

bool locked;             /* the mutex */
bool is_set;             /* the callback, guarded by the mutex */
bool in_sight;           /* whether the bucket of the topic has some callback */
bool watched;            /* whether the subscription's watchers have the thread's word */
bool marked;             /* the subscription */
bool left;               /* by a publisher to the thread */
bool changed;            /* callbacks, guarded by the mutex */
byte epoch;
byte arrived, reported;
byte by_callback = 1;    /* messages that the callback will publish */
byte finished;

inline raise_epoch() { epoch++ }

inline leave() {
#if BUG != 9
  left = true;
#endif
  raise_epoch()
}

/* With the mutex. */
inline look() {
  n = arrived;
  if
  :: n > reported ->
    reported = n;
    if
    :: atomic { by_callback > 0 -> by_callback--; arrived++ };
#if BUG != 4
      leave()
#endif
    :: true
    fi
  :: else
  fi
}

inline report_or_leave() {
  if
  :: atomic { !locked -> locked = true };
    if
    :: is_set -> look()
    :: is_set ->            /* would wait */
#if BUG != 5
      leave()
#else
      skip
#endif
    :: else
    fi;
    locked = false
  :: locked ->
#if BUG != 1
    leave()
#else
    skip
#endif
  fi
}

proctype publisher() {
  byte n, sent;
  bool spares;
  do
  :: sent < MESSAGES ->
    spares = in_sight;
    arrived++;
    if
    :: spares -> report_or_leave()
#if BUG == 3
    :: else
#else
    :: !spares && watched ->
#if BUG == 7
       raise_epoch();
       marked = true
#else
       marked = true;
       raise_epoch()
#endif
    :: !spares && !watched
#endif
    fi;
    sent++
  :: else -> break
  od;
  finished++
}

proctype setter() {
  byte n;
  atomic { !locked -> locked = true };
  in_sight = true;
  changed = true;
  raise_epoch();
  is_set = true;
  look();
  locked = false;
  finished++
}

/* Each is an exchange of its own. */
inline take_marks() {
#if BUG != 10
  is_marked = changed;
#endif
  changed = false;
  d_step { is_marked = is_marked || marked; marked = false };
  d_step { is_marked = is_marked || left; left = false }
}

inline look_at_marked() {
  if
  :: is_marked -> look()
  :: else
  fi;
  is_marked = false
}

proctype thread() {
  byte n, seen;
  bool is_marked;
end_without_callback:
  atomic { !locked && is_set -> locked = true };
again:
#if BUG != 6
  watched = true;
#endif
#if BUG == 2
  take_marks();
  look_at_marked();
  seen = epoch;
#elif BUG == 8
  take_marks();
  seen = epoch;
  look_at_marked();
#else
  seen = epoch;
  take_marks();
  look_at_marked();
#endif
#if BUG == 6
  watched = true;
#endif
  locked = false;
end_asleep:
  epoch != seen;
  atomic { !locked -> locked = true };
  goto again
}

init {
  if
  :: in_sight = true      /* another callback, of the same bucket */
  :: true
  fi;
  atomic { run publisher(); run publisher(); run setter(); run thread() };
  finished == PUBLISHERS + 1 && timeout -> assert(reported == arrived)
}

/* Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
 *
 * Question: where a topic is transferred between clusters and no process matches endpoints, is there
 * a landing once publisher and subscription are created, does the publisher find it, is it accessed
 * only while it is there, and is it freed in the end?
 *
 * The creator of an endpoint makes a landing that is missing, after its row is live: of two endpoints
 * that are created at a time at least one sees the other. The block comes about in a hand (hands.pml), so it is attached under
 * the registry lock if it is still wanted and none is there, else given back. Attaching raises
 * `changes`. The publisher counts a reader in another cluster as one, and gives it a seat, once it
 * finds a landing there. The last subscription of a cluster retires the landing, which is freed when
 * the publisher has been seen out of its phase, or taken up again before. Two subscriptions in one
 * receiving cluster; one may be killed at any step of its creation. A step of a process that holds
 * the registry lock is one step; for the order of stores and loads see freeing.pml, where a landing
 * stands for the subscription's memory.
 *
 * BUG 1: landings made before the row is live
 * BUG 2: attaching does not raise changes
 * BUG 3: freed without a look at the publisher's phase
 * BUG 4: attached although the last subscription has gone
 * BUG 5: the last subscription does not retire the landing
 * BUG 6: the first subscription to leave retires the landing
 * BUG 7: attached although there is one
 * BUG 8: a reader without a landing is one
 * BUG 9: a landing is taken up again while it is freed
 * BUG 10: a killed subscription's landing stays
 * BUG 11: a retired landing is not taken up, nor waited for
 */
#define MESSAGES 2
#define none 0
#define PUBLISHER 0       /* its row; the subscriptions are 1 and 2 */

bool live[3], is_made[3];
byte changes;
byte attached, retired;   /* number of the block; also of its maker */
bool is_freeing;          /* the retired one */
bool backed[4];
bool phase;
bool killed, has_reaped, has_stopped[3];

/* Any access to the bytes of the landing. */
inline touch(b) {
  assert(b != none && backed[b])
}

#define is_wanted (live[PUBLISHER] && (live[1] || live[2]))
#define is_missing (is_wanted && attached == none && (retired == none || BUG == 11))

/* Block p + 1 is that of process p. Also waits for a landing that is being freed. */
inline make_landing(p) {
  do
  :: atomic { is_wanted && attached == none && retired != none && BUG != 11 &&
              (!is_freeing || BUG == 9) ->
       attached = retired;
       retired = none;
       changes++
     };
     break
  :: is_missing ->
     backed[p + 1] = true;
     if
     :: atomic { (is_wanted || BUG == 4) && (attached == none || BUG == 7) &&
                 (retired == none || BUG == 11) ->
          attached = p + 1;
          changes = changes + (BUG == 2 -> 0 : 1)
        }
     :: atomic { !((is_wanted || BUG == 4) && (attached == none || BUG == 7) &&
                   (retired == none || BUG == 11)) -> backed[p + 1] = false }
     fi
  :: atomic { !is_wanted || attached != none -> break }
  od
}

inline create(p) {
#if BUG == 1
  make_landing(p);
#endif
  atomic { live[p] = true; changes++ };
#if BUG != 1
  make_landing(p);
#endif
  is_made[p] = true
}

inline retire() {
  if
  :: attached != none && BUG != 5 && ((!live[1] && !live[2]) || BUG == 6) ->
     retired = attached;
     attached = none;
     is_freeing = false
  :: else
  fi
}

/* Under the registry lock. */
inline close(p) {
  atomic {
    live[p] = false;
    is_made[p] = false;
    changes++;
    if
    :: p != PUBLISHER -> retire()
    :: else
    fi
  }
}

proctype Publisher() {
  byte n, seen, to;
  bool must_know, knows;
  create(PUBLISHER);
  do
  :: n < MESSAGES ->
     n++;
     atomic { must_know = is_made[1] || is_made[2]; phase = true };
     atomic {
       if
       :: changes != seen ->
          seen = changes;
          knows = (live[1] || live[2]) && (attached != none || BUG == 8);
          to = attached
       :: else
       fi;
       assert(knows || !must_know || !(is_made[1] || is_made[2]));
       assert(attached == none || !has_stopped[1] || !has_stopped[2] || !has_reaped)
     };
     if
     :: knows -> touch(to)
     :: else
     fi;
     phase = false
  :: break
  od;
  close(PUBLISHER);
  has_stopped[PUBLISHER] = true
}

proctype Subscription(byte p) {
  {
    create(p);
    close(p)
  } unless { p == 1 && killed };
  has_stopped[p] = true
}

/* Kills the first subscription, or not. Its hand is emptied by its reaper, which also closes it. */
proctype Reaper() {
  if
  :: killed = true;
     has_stopped[1];
     atomic {
       if
       :: live[1] ->
          live[1] = false;
          is_made[1] = false;
          changes++;
          if
          :: BUG != 10 -> retire()
          :: else
          fi
       :: else
       fi;
       backed[2] = backed[2] && (attached == 2 || retired == 2)
     }
  :: skip
  fi;
  has_reaped = true
}

/* Frees what is retired, and everything with the publisher. Repeated whenever the lock is taken. */
proctype Sweeper() {
  byte b;
  do
  :: atomic { retired != none && (!phase || BUG == 3) -> is_freeing = true; b = retired };
     atomic { backed[b] = false; retired = none; is_freeing = false }
  :: atomic { has_stopped[PUBLISHER] && has_stopped[1] && has_stopped[2] && has_reaped &&
              retired == none -> break }
  od;
  if
  :: attached != none -> backed[attached] = false
  :: else
  fi
}

init {
  atomic {
    run Publisher(); run Subscription(1); run Subscription(2); run Reaper(); run Sweeper()
  };
  _nr_pr == 1;
  assert(!backed[1] && !backed[2] && !backed[3])
}

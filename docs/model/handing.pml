/* Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
 *
 * Question: is each record of a topic that is transferred between clusters delivered, in order, or
 * counted as lost, and does the subscription learn of it, so that the publisher's memory can be
 * freed: though the mover is killed with a record in hand, or the publisher at any step, the pipe is
 * full, and an executor takes only what is there?
 *
 * Follows TransferSender::hand_over, PacketMover and CopyMover (handle, recover), HandedBefore,
 * closing.cpp, RecordFinder (next, settle) and Source::settle. All stores here are seq_cst, but for
 * the mark, which is stored before one. A record is one packet.
 *
 * RUN RECORDS=2
 * RUN RECORDS=3 (long)
 * BUG 1 (reversed): the publisher does not look for a successor of the mover
 * BUG 2: of drops in a row only the first one is told
 * BUG 3 RECORDS=3: publisher looks whether a record is under way before it stores closed
 * BUG 4: losses are settled in an empty take only
 * BUG 5 (reversed): a successor does not have the readers look
 * BUG 6 (reversed): a successor leaves a record alone that was marked and not done
 * BUG 7 (reversed): the reaper does not close the landing
 * BUG 8 RECORDS=3 (reversed): closed stored before handed
 * BUG 9: a hint pushed before done
 * BUG 10 (reversed): publisher does not look whether a record was given up before it stored closed
 * BUG 11 RECORDS=3: settled although a later record was closed meanwhile
 */
#define CAPACITY 1

chan pipe = [CAPACITY] of { byte };
chan queue = [2 * RECORDS] of { byte };   /* hints */
byte last;                                /* of the topic DSM */
byte handed, closed, arrived, done;       /* of the landing */
bool mark[RECORDS + 1];
byte successors;
bool resync;
bool orphan;
byte taken;                               /* of the source */
bool mover_dies, publisher_dies;
bool refused[RECORDS + 1];                /* history: found no room in the pipe */

inline publish() {
  last++;
  before = successors;
  dropped = false;
  if
  :: atomic { nfull(pipe) -> pipe!last }
  :: d_step { full(pipe) -> refused[last] = true; dropped = true }
  fi;
#if BUG == 8
  closed = last;
#endif
  if
  :: !dropped ->
     old = handed;
     handed = last;
#if BUG != 1
     if
     :: successors != before && done < last -> handed = old; dropped = true
     :: else
     fi
#endif
  :: dropped
  fi;
#if BUG == 3
  is_under_way = done < handed;
#endif
  closed = last;
  if
  :: dropped ->
#if BUG == 2
     is_under_way = true;
#elif BUG != 3
     is_under_way = done < handed;
#endif
     if
     :: was_dropped && is_under_way
     :: else -> resync = true
     fi;
     was_dropped = true
  :: else ->
     was_dropped = false;
#if BUG != 10
     if
     :: done >= last && !mark[last] -> resync = true
     :: else
     fi
#endif
  fi;
  is_under_way = false
}

inline close_publisher() {
#if BUG != 7
  closed = last;
#endif
  resync = true;
  orphan = true
}

/* As with RELIABLE + KEEP_ALL, it waits until all is taken or counted as lost, and then leaves. */
proctype Publisher() {
  byte before, old;
  bool dropped, was_dropped, is_under_way;
  {
    do
    :: last < RECORDS -> publish()
    :: last == RECORDS -> taken == RECORDS; break
    od
  } unless { publisher_dies };
  close_publisher()
}

inline arrive(n) {
  mark[n] = true;
  arrived = n;
#if BUG == 9
  queue!n;
  done = n
#else
  done = n;
  queue!n
#endif
}

inline handle() {
  if
  :: n > done && n <= last -> arrive(n)
  :: else
  fi;
  n = 0
}

inline recover() {
  successors++;
#if BUG != 5
  resync = true;
#endif
  newest = handed;
  do
  :: nempty(pipe) -> pipe?n; handle()
  :: empty(pipe) -> break
  od;
  if
  :: newest == 0
  :: newest != 0 && mark[newest] ->
#if BUG != 6
     if
     :: done < newest -> arrive(newest)
     :: else
     fi
#else
     skip
#endif
  :: newest != 0 && !mark[newest] ->
     if
     :: done < newest -> done = newest
     :: else
     fi;
     resync = true
  fi;
  newest = 0
}

/* May be killed at any step; the successor lives. */
proctype Mover() {
  byte n, newest;
  {
end:
    do
    :: pipe?n -> handle()
    od
  } unless { mover_dies };
  n = 0;
  recover();
end_successor:
  do
  :: pipe?n -> handle()
  od
}

#define has_records (resync || len(queue) > 0 || backlog != 0)

/* The records in (noted, arrived] that have a mark. */
inline scan() {
  d_step {
    resync = false;
    do
    :: nempty(queue) -> queue?n
    :: empty(queue) -> break
    od;
    n = arrived;
    do
    :: noted < n ->
       noted++;
       backlog = (mark[noted] -> backlog | (1 << noted) : backlog)
    :: else -> break
    od;
    n = 0;
    unsettled = true
  }
}

inline settle() {
  if
  :: unsettled ->
     published = last;
     is_settled = closed >= published;
     under_way = handed;
     is_settled = is_settled && done >= under_way;
     is_settled = is_settled && arrived <= noted;
#if BUG != 11
     is_settled = is_settled && closed == published;
#endif
     if
     :: is_settled ->
        d_step {
          do
          :: taken < published ->
             taken++;
             assert(refused[taken] || mover_dies || publisher_dies)
          :: else -> break
          od;
          noted = published;
          unsettled = false
        }
     :: else
     fi;
     published = 0; under_way = 0; is_settled = false
  :: else
  fi
}

inline deliver(record) {
  d_step {
    assert(record > taken);
    /* What was skipped counts as lost. */
    taken = record
  };
#if BUG != 4
  if
  :: !has_records -> settle()
  :: else
  fi
#endif
}

/* The oldest of the backlog. */
inline pop_backlog() {
  d_step {
    do
    :: (backlog & (1 << n)) == 0 -> n++
    :: else -> break
    od;
    backlog = backlog & ~(1 << n)
  }
}

/* One take: until a record is found, or nothing is left. */
inline take() {
  do
  :: resync -> scan()
  :: !resync && backlog != 0 ->
     pop_backlog();
     if
     :: n > taken -> deliver(n); break
     :: else -> n = 0
     fi
  :: !resync && backlog == 0 && len(queue) > 0 ->
     queue?n;
     if
     :: resync -> scan()                /* finds n as well */
     :: !resync && n > noted -> noted = n; deliver(n); break
     :: !resync && n <= noted -> n = 0
     fi
  :: !resync && backlog == 0 && len(queue) == 0 -> settle(); break
  od;
  n = 0
}

/* An executor takes when there is something to take. An end state in which it sleeps and the
 * publisher's memory is not free is an error. */
proctype Subscription() {
  byte n, noted, published, under_way;
  byte backlog;
  bool unsettled, is_settled;
  do
  :: orphan && taken >= last -> break
  :: has_records && !(orphan && taken >= last) -> take()
  od
}

/* One dies at any step, or none. If both die during one hand-over, `handed` may name a record that
 * nobody gives up, and the memory stays until the subscription ends. */
proctype Killer() {
  if
  :: mover_dies = true
  :: publisher_dies = true
  :: skip
  fi
}

init {
  atomic { run Publisher(); run Mover(); run Subscription(); run Killer() }
}

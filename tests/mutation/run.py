#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Which planted faults do the tests catch? run.py BUILD -o RESULT.json, in a tree of plant.py that was built.

The suite runs once to record which cases reach which fault; then, for each fault, the cases that reach it run with the fault active, quick
ones first, until one fails that passes without it. Cases that fail in the first run do not count. With --coverage the suite's run starts
from empty counters (build with --coverage), so that gcov reports on it afterwards.
"""
import argparse
import collections
import concurrent.futures
import json
import os
import pathlib
import re
import shutil
import subprocess
import xml.etree.ElementTree as xml

MAX_FAULTS, MAX_CASES, NAME_BYTES = 128, 1 << 14, 128  # as in fault.h
BATCH_SECONDS = (10, 60, 300, float('inf'))


def run_suite(build, folder, jobs):
    """Cases of the suite: (program, case) -> seconds; the failed ones; faults -> cases that reach them."""
    reach = folder / 'reach'
    reach.write_bytes(bytes(64 + MAX_CASES * (NAME_BYTES + MAX_FAULTS)))
    environment = dict(os.environ, CATENA_FAULT_REACH=str(reach), GTEST_OUTPUT=f'xml:{folder}/results/')
    with open(folder / 'suite.log', 'w') as log:
        subprocess.run(['ctest', '-j', str(jobs), '-E', '^python'], cwd=build, env=environment, stdout=log, stderr=log)
    seconds, failed = {}, set()
    for file in (folder / 'results').glob('*.xml'):
        program = re.sub(r'(_\d+)?\.xml$', '', file.name)
        for case in xml.parse(file).iter('testcase'):
            if case.get('status') != 'run':
                continue
            name = (program, f"{case.get('classname')}.{case.get('name')}")
            seconds[name] = float(case.get('time'))
            if case.find('failure') is not None:
                failed.add(name)
    data, cases = reach.read_bytes(), collections.defaultdict(list)
    for number in range(1, min(MAX_CASES, int.from_bytes(data[:4], 'little') + 1)):
        name = data[64 + number * NAME_BYTES:64 + (number + 1) * NAME_BYTES].split(b'\0')[0].decode().split(' ', 1)
        row = data[64 + MAX_CASES * NAME_BYTES + number * MAX_FAULTS:][:MAX_FAULTS]
        for fault in (i for i, byte in enumerate(row) if byte and len(name) == 2):
            cases[fault].append(tuple(name))
    return seconds, failed, cases


def run_cases(build, program, cases, seconds, fault):
    """The cases that fail, at most one; a hang or a crash counts for the last case that began."""
    environment = dict(os.environ, CATENA_FAULT=str(fault), GTEST_FAIL_FAST='1')
    filters = ':'.join(cases)
    try:
        run = subprocess.run([f'./{program}', f'--gtest_filter={filters}'], cwd=build, env=environment, stdin=subprocess.DEVNULL,
                             stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=30 + 4 * seconds)
        output, ok = run.stdout.decode(errors='replace'), run.returncode == 0
    except subprocess.TimeoutExpired as hung:
        output, ok = (hung.stdout or b'').decode(errors='replace'), False
    if ok:
        return []
    named = re.findall(r'^\[  FAILED  \] ([^\s,]+)', output, re.M) or re.findall(r'^\[ RUN      \] (\S+)', output, re.M)
    return named[:1] if re.search(r'^\[  FAILED', output, re.M) else named[-1:]


def catch(build, fault, reached, seconds, failed, first):
    """The case that catches a fault, or None."""
    waiting = sorted((case for case in reached if case not in failed), key=lambda case: (case[1] not in first, seconds.get(case, 1)))
    for limit in BATCH_SECONDS:
        taken, total = [], 0
        while waiting and (not taken or total + seconds.get(waiting[0], 1) < limit):
            taken.append(waiting.pop(0))
            total += seconds.get(taken[-1], 1)
        by_program = collections.defaultdict(list)
        for program, case in taken:
            by_program[program].append(case)
        for program, cases in by_program.items():
            while cases:
                found = run_cases(build, program, cases, sum(seconds.get((program, case), 1) for case in cases), fault)
                if not found or found[0] not in cases:
                    break
                if not run_cases(build, program, found, seconds.get((program, found[0]), 1), -1):
                    return f'{program} {found[0]}'
                cases = cases[cases.index(found[0]) + 1:]  # fails without the fault, too
    return None


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('build', type=pathlib.Path)
    parser.add_argument('-o', '--output', type=pathlib.Path, required=True)
    parser.add_argument('--jobs', type=int, default=2)
    parser.add_argument('--coverage', action='store_true')
    parser.add_argument('--known', type=pathlib.Path, help='result of an earlier run, whose catching cases run first')
    given = parser.parse_args()
    build = given.build.resolve()
    folder = given.output.resolve().with_suffix('.run')
    shutil.rmtree(folder, ignore_errors=True)
    (folder / 'results').mkdir(parents=True)
    if given.coverage:
        for counter in build.rglob('*.gcda'):
            counter.unlink()
    seconds, failed, reached = run_suite(build, folder, given.jobs)
    if given.coverage:
        subprocess.run(['tar', 'cf', folder / 'counters.tar', '--files-from=-'], cwd=build, check=True,
                       input='\n'.join(str(c.relative_to(build)) for c in build.rglob('*.gcda')).encode())
    faults = json.loads((build / '../../faults.json').read_text())
    known = json.loads(given.known.read_text())['faults'] if given.known else []
    first = {fault['caught_by'].split()[1] for fault in known if fault['caught_by']}

    def judge(fault):
        cases = reached[fault['number']]
        found = catch(build, fault['number'], cases, seconds, failed, first)
        print(f"{fault['number']}: {fault['file']}:{fault['line']} {fault['kind']}: {found or f'not caught by {len(cases)} cases'}", flush=True)
        return dict(fault, reached_by=len(cases), caught_by=found)

    with concurrent.futures.ThreadPoolExecutor(given.jobs) as pool:
        judged = list(pool.map(judge, faults))
    caught = sum(1 for fault in judged if fault['caught_by'])
    given.output.write_text(json.dumps({'cases': len(seconds), 'failed': sorted(map(list, failed)), 'caught': caught, 'faults': judged}, indent=1))
    print(f'{caught} of {len(judged)} faults caught; {len(seconds)} cases, {sum(seconds.values()):.0f} s; {len(failed)} failed without a fault')


if __name__ == '__main__':
    main()

"""What a run of a case is worth: true errors, estimated errors and the verdict."""

from decimal import Decimal

BOUNDED, REFUSED, FAILED, DEFECT = "bounded", "refused", "failed-row", "DEFECT"
COLUMNS = ("parameter", "variant", "speed", "crank", "mode", "error", "estimate", "ratio", "rounding", "verdict", "reason")
MISSED = "accuracy= is not reached"  # which the table shows, so the row counts as bounded
HUGE = Decimal("1e9")  # for errors of frequencies that are nearly zero


class Result:
    """One row of a table of the stress test."""

    def __init__(self, case, place=("-", "-"), mode="-", error=None, estimate=None, rounding=None, verdict=BOUNDED, reason="-"):
        self.ratio = None # the largest ratio of error to estimate, over all modes of the row
        self.case, self.place, self.mode, self.error, self.estimate, self.rounding = case, place, mode, error, estimate, rounding
        self.verdict, self.reason = verdict, " ".join(reason.split()) or "-"

    def line(self):
        def number(value):
            return "-" if value is None else f"{value:.3e}"
        return " ".join([f"{float(self.case.parameter):.6g}", self.case.variant, *(f"{p}" for p in self.place), str(self.mode),
                         *map(number, (self.error, self.estimate, self.ratio, self.rounding)), self.verdict, self.reason])


def relative_error(found, exact):
    """Of the frequency that is written, as the error columns are."""
    if found == exact:
        return Decimal(0)
    return min(HUGE, abs(found - exact)/abs(found)) if found else HUGE


def judge_row(case, row, exact, on_mesh):
    """The mode with the largest error, or one whose error exceeds its estimate."""
    place = tuple(f"{float(value):.8g}" for value in row.place)
    if row.failure:
        return Result(case, place, verdict=FAILED, reason=row.failure)
    if not exact:
        return Result(case, place, verdict=DEFECT, reason="no reference; run: make references")
    results = []
    for mode, (found, estimate) in enumerate(zip(row.frequencies, row.errors)):
        rounding = relative_error(found, on_mesh[mode]) if on_mesh else None
        results.append(Result(case, place, mode + 1, relative_error(found, exact[mode]), estimate, rounding))
    worst = max(results, key=lambda result: result.error)
    ratio = max(result.error/result.estimate if result.estimate else Decimal(result.error > 0)*HUGE for result in results)
    if ratio > 1:
        worst = max(results, key=lambda result: result.error - result.estimate)
        worst.verdict, worst.reason = DEFECT, "the error exceeds its estimate"
    elif any(estimate > case.asked() for estimate in row.errors):
        worst.reason = MISSED
    worst.ratio = ratio
    return worst


def judge(case, status, message, rows, exact, on_mesh):
    """All rows of a case."""
    results = judge_run(case, status, message, rows, exact, on_mesh)
    for result in results:
        if case.wanted and result.verdict not in (case.wanted, DEFECT):
            result.reason = f"should be {case.wanted}, is {result.verdict}: {result.reason}"
            result.verdict = DEFECT
    return results


def judge_run(case, status, message, rows, exact, on_mesh):
    """The same without what a case wants."""
    if status == 2 and message.strip():
        first = message.splitlines()[0]
        return [Result(case, verdict=REFUSED, reason=first.split("error: ", 1)[-1])]
    if status not in (0, 1) or not rows:
        return [Result(case, verdict=DEFECT, reason=f"exit status {status}: {message.strip()[:200]}")]
    if (status == 1) != any(row.failure for row in rows):
        return [Result(case, verdict=DEFECT, reason=f"exit status {status} does not match the rows")]
    exact, on_mesh = ((kept or []) + [[]]*len(rows) for kept in (exact, on_mesh))
    return [judge_row(case, row, exact[i], on_mesh[i]) for i, row in enumerate(rows)]

"""The looks of the page, by day, by night, on a phone and on paper."""

__all__ = ["STYLE"]

STYLE = """\
:root {
  color-scheme: light dark;
  --ink: #1f2933; --muted: #52606d; --line: #d9dee4; --ground: #f5f6f8; --card: #ffffff;
  --accent: #1e5a8a; --good: #1b6b3a; --bad: #b42318; --bad-ground: #fdecea; --code: #eef1f4;
}
@media (prefers-color-scheme: dark) {
  :root {
    --ink: #e4e7eb; --muted: #a3b0bd; --line: #38444f; --ground: #14191f; --card: #1d242c;
    --accent: #8cc3f0; --good: #7fd19b; --bad: #ff9a8d; --bad-ground: #3d1f1c; --code: #2a333d;
  }
}
* { box-sizing: border-box; }
html { scroll-behavior: smooth; }
body {
  margin: 0 auto; padding: 2rem 1.25rem 3rem; max-width: 78rem; background: var(--ground);
  color: var(--ink); font: 1rem/1.55 system-ui, -apple-system, "Segoe UI", Roboto, sans-serif;
}
a { color: var(--accent); text-underline-offset: 0.15em; }
a:focus-visible, [tabindex]:focus-visible { outline: 2px solid var(--accent); outline-offset: 2px; }
h1 { font-size: clamp(1.6rem, 4vw, 2.3rem); line-height: 1.15; margin: 0 0 0.6rem; }
h2 { font-size: 1.35rem; line-height: 1.25; margin: 0; }
h3 { font-size: 0.8rem; letter-spacing: 0.05em; text-transform: uppercase; color: var(--muted);
  margin: 0 0 0.35rem; }
p { margin: 0 0 0.7rem; }
.lead { max-width: 46rem; color: var(--muted); }
.scroll { overflow-x: auto; }
section { margin-top: 1.75rem; padding: 1.4rem; background: var(--card); border-radius: 0.8rem;
  border: 1px solid var(--line); }
.head { display: flex; flex-wrap: wrap; gap: 0.3rem 1rem; align-items: baseline;
  justify-content: space-between; margin-bottom: 1.1rem; }
.head p { margin: 0; color: var(--muted); font-size: 0.9rem; }
.beside { display: grid; gap: 1.5rem 2rem; grid-template-columns: minmax(0, 1fr); }
@media (min-width: 60rem) {
  .beside { grid-template-columns: minmax(0, 1fr) 19.5rem; }
  aside { border-left: 1px solid var(--line); padding-left: 1.5rem; align-self: start;
    position: sticky; top: 1rem; }
}
aside > div { margin-bottom: 1.15rem; }
aside p { margin-bottom: 0.4rem; font-size: 0.95rem; }
.law { font-family: Cambria, "STIX Two Text", "Times New Roman", serif; font-size: 1.06rem;
  line-height: 1.75; overflow-wrap: anywhere; }
.source { color: var(--muted); font-size: 0.85rem; }
.pictures { display: grid; gap: 1.75rem 1.25rem; align-items: start;
  grid-template-columns: minmax(0, 1fr); }
@media (min-width: 40rem) {
  .pictures { grid-template-columns: repeat(2, minmax(0, 1fr)); }
  .pictures > :not(.half) { grid-column: 1 / -1; }
}
figure { margin: 0; min-width: 0; }
figure > a { display: block; background: #ffffff; border: 1px solid var(--line);
  border-radius: 0.4rem; padding: 0.5rem; }
img { display: block; width: auto; max-width: 100%; height: auto; max-height: 36rem;
  margin: 0 auto; }
figcaption { margin-top: 0.55rem; font-size: 0.95rem; }
figcaption strong { display: block; }
table { border-collapse: collapse; width: 100%; font-size: 0.88rem; }
caption { text-align: left; color: var(--muted); padding: 0.5rem 0 0.25rem; }
th, td { padding: 0.28rem 0.6rem 0.28rem 0; text-align: left; vertical-align: top;
  border-bottom: 1px solid var(--line); }
thead th { color: var(--muted); font-weight: 600; }
tbody th { font-weight: 400; min-width: 6.5rem; }
.half table { font-size: 0.78rem; }
.half th, .half td { padding-right: 0.35rem; }
.number { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
th:last-child, td:last-child { padding-left: 0.4rem; padding-right: 0; }
.summary td, .summary th { padding-left: 0; }
sub, sup { line-height: 0; }
.half td.number { white-space: normal; }
.ok { color: var(--good); white-space: nowrap; }
.bad { color: var(--bad); font-weight: 700; white-space: nowrap; }
.wrong { color: var(--bad); background: var(--bad-ground); border-left: 4px solid var(--bad);
  padding: 0.6rem 0.9rem; border-radius: 0.3rem; font-weight: 600; }
.small { margin: 0.5rem 0 0; font-size: 0.82rem; color: var(--muted); overflow-wrap: anywhere; }
pre { margin: 0.5rem 0 0; padding: 0.5rem 0.7rem; background: var(--code); border-radius: 0.35rem;
  font-size: 0.8rem; white-space: pre-wrap; overflow-wrap: anywhere; }
code { font-family: ui-monospace, "Cascadia Mono", Menlo, Consolas, monospace; }
footer { margin-top: 2rem; font-size: 0.85rem; color: var(--muted); }
@media (max-width: 30rem) {
  body { padding: 1.2rem 0.7rem 2rem; }
  section { padding: 1rem 0.85rem; border-radius: 0.5rem; }
  table { font-size: 0.78rem; }
  th, td { padding-right: 0.35rem; }
  tbody th { min-width: 5.5rem; }
  td.number { white-space: normal; }
}
@media print {
  :root {
    --ink: #000000; --muted: #444444; --line: #bbbbbb; --ground: #ffffff; --card: #ffffff;
    --accent: #000000; --good: #1b6b3a; --bad: #b42318; --bad-ground: #ffffff; --code: #f3f3f3;
  }
  body { max-width: none; padding: 0; font-size: 9.5pt; }
  section { border: 0; padding: 0; border-radius: 0; break-before: page; }
  section:first-of-type { break-before: auto; }
  figure, table, aside > div { break-inside: avoid; }
  .beside { grid-template-columns: minmax(0, 1fr); }
  aside { border: 0; padding: 0; columns: 2; position: static; }
  img { max-height: 12cm; }
  .vector { display: none; }
}
"""
"""A style sheet: no script, no font and no picture from elsewhere."""

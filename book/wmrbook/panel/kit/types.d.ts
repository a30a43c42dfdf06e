// What the modules of the kit tell each other, for `tsc`.

/** The kit in one script is this function, see book/tools/kit.py. */
declare const wmrKit: () => void;
/** Programs by name, where a page has the kit. */
declare var wmrPanels: Record<string, any>;
/** What a figure found, for tests. */
interface HTMLDivElement { found?: any }
interface HTMLElement { grips?: Map<string, any>; stage?: any }

/** Numbers: x and y in m, heading in rad; and two of anything. Tuples would be in the way. */
type Pose = any;
type Point = any;
type Colours = Record<string, string>;
type Box = { left: number; top: number; width: number; height: number };
type Values = Record<string, any>;
type Gains = Record<string, number>;

/** A run, as `simulate` gives it: samples in columns. */
type Run = {
  n: number;
  outcome: 'ARRIVED' | 'TIMED_OUT' | 'DIVERGED' | 'COMPLETED';
  peakOmega?: number;
  pathLength?: number;
} & Partial<Record<
  't' | 'x' | 'y' | 'heading' | 'rho' | 'alpha' | 'theta' | 'v' | 'omega' | 'V'
    | 'goalX' | 'goalY' | 'goalHeading', Float64Array>>;

/** What `simulate` takes. */
type Options = {
  start: Pose; goal?: Pose; reference: 'circle' | null; law: string; method: string;
  gains: Gains; feedback?: Gains; dt: number; duration: number; arrivalRadius?: number;
  hysteresis?: number; wheels?: Record<string, number>; lastTurn?: Record<string, number> | null;
};

/** Where a picture of the plane looks. */
type View = {
  box: Box; scale: number; zoom: number;
  toScreen(x: number, y: number): Point; toWorld(x: number, y: number): Point;
};

/** An axis of a pane: from, to, title, and what a number on it is called. */
type Axis = [number, number, string?, ((value: number) => string)?];
type Spec = {
  x: Axis; y: Axis; alt: string; given?: string; equal?: boolean; bare?: boolean; main?: boolean;
  lawn?: boolean | number;
  ghosts?: boolean;
  scrub?(x: number, y: number, moved: Point | null, values: Values, found: any): Values | null;
};
type Looks = { width?: number; dash?: number[] };
/** What a drawing draws on, in the world's units; a role is a colour's, see board.js. */
type Pane = {
  ctx: CanvasRenderingContext2D; box: Box; view: View; range: number[]; pixel: number;
  trail: Point[][];
  at(x: number, y: number): Point;
  ink(role: string): string;
  line(points: Point[], role?: string, looks?: Looks): void;
  path(xs: ArrayLike<number>, ys: ArrayLike<number>, role?: string,
    looks?: Looks & { from?: number; to?: number }): void;
  curve(f: (x: number) => number, role?: string, looks?: Looks): void;
  area(points: Point[], role: string, share?: number): void;
  dot(...placeRoleLooks: any[]): void;
  cross(x: number, y: number, role?: string, size?: number): void;
  arrow(...endsRoleLooks: any[]): void;
  text(said: string, ...placeLooks: any[]): void;
  angle(...placeFromByNameRole: any[]): void;
  robot(pose: Pose, share?: number, looks?: { size?: number; role?: string }): void;
  state(rho: number, alpha: number, theta: number): void;
  errors(pose: Pose, errors: any, goal: Pose): void;
  pose(pose: Pose, name: string): void;
  name(): void;
  rect(...endsRoleShare: any[]): void;
};
type Handle = {
  id: string; pane: string; at: Point; says: string;
  move(...placeAndKey: any[]): Values;
};
type Setup = {
  sentence: string; knobs: Values[]; data: any; ask: Values | null;
  steps: { title: string, says: string, to: Values }[]; step?: number;
};

/** A live figure, see live.js. */
type Drawing = {
  find(values: Values, setup: Setup): any;
  panes(values: Values, found: any, setup: Setup, hidden: boolean): Record<string, Spec>;
  draw(panes: Record<string, Pane>, values: Values, found: any, hidden: boolean,
    setup: Setup): void;
  say(values: Values, found: any, setup: Setup): Record<string, string | number>;
  handles?(values: Values, found: any, setup: Setup): Handle[];
};

/** What a chapter's stage plays, see stage.js. */
type Play = {
  find(values: Values, setup: any): any;
  say(values: Values, found: any, setup: any): Record<string, string | number>;
  look?(values: Values, found: any, setup: any, how: string): number[] | null;
  corner?(values: Values, found: any, size: any, scene: any): any;
  draw?(pane: Pane, values: Values, found: any, now: any, setup: any): void;
  above?(pane: Pane, values: Values, found: any, now: any, setup: any): void;
};

/** A widget's model, as anywidget gives it. */
type Model = {
  get(name: string): any; set(name: string, value: any): void; save_changes(): void;
  on(event: string, listener: (...told: any[]) => void): void;
  off(event: string, listener: (...told: any[]) => void): void;
  send(content: any): void;
  widget_manager?: any;
};
type Context = { model: Model; el: HTMLElement };

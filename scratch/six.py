from benchmarks.validation import _gait_walks as w
from footfall.errors import InputError
from concurrent.futures import ProcessPoolExecutor
import sys
def go(job):
    s,p,seed=job
    try: w.walk_straight(w.Case(s,p,seed),110.0,None) ; return None
    except InputError as e: return (job,str(e)[:150])
if __name__=='__main__':
    jobs=[(s,p,seed) for seed in range(int(sys.argv[1]),int(sys.argv[2])) for s,p in (('taller',1.3),('reference',1.3),('reference',1.0),('shorter',1.3),('reference',1.5))]
    with ProcessPoolExecutor(2) as e: r=[x for x in e.map(go,jobs) if x]
    print(len(jobs),'walks',len(r),'fell'); [print(x) for x in r]
